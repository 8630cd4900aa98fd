#pragma once

#include <cstdint>
#include <vector>

namespace render::gl {

constexpr int kNoiseSize = 256;

/// Grain that tiles: kNoiseSize^2 bytes, mean one half, the same on every machine (integer arithmetic).
const std::vector<std::uint8_t>& grain_picture();

}  // namespace render::gl
