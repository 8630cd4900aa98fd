#pragma once

#include <cstdint>
#include <vector>

namespace render {

/// RGBA, 8 bits a channel, sRGB, rows top-down, no padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  // 4 * width * height
};

}  // namespace render
