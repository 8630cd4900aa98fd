// A stream as PNG files hold it, made fast.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace render {

/// A zlib stream (RFC 1950) of the bytes. Of repetitions it seeks runs of one byte alone; the rest is coded by how often each byte
/// occurs. Noise and flat areas, as a filtered picture's rows have them, come out as small as zlib's fastest level makes them.
std::vector<std::uint8_t> deflate_runs(std::span<const std::uint8_t>);

}  // namespace render
