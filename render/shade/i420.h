// To the encoder's colours. Plain loops over whole numbers: the compiler makes wide ones of them.
#pragma once

#include <cstdint>

namespace render::shade {
namespace {

// BT.709 limited range in 16-bit fixed point: 219/255 * (0.2126, 0.7152, 0.0722) and 224/255 of the differences
constexpr int kOne = 65536;

inline std::uint8_t luma(std::uint32_t rgba) {
  const int r = rgba & 255, g = rgba >> 8 & 255, b = rgba >> 16 & 255;
  return static_cast<std::uint8_t>((11966 * r + 40254 * g + 4064 * b + kOne / 2 + 16 * kOne) >> 16);
}

void i420(const std::uint8_t* rgba, int width, int height, std::uint8_t* out) {
  const std::int64_t w = width, h = height, half = w / 2;
  std::uint8_t *u_out = out + w * h, *v_out = u_out + half * (h / 2);
  for (std::int64_t y = 0; y < h; y += 2) {
    std::uint8_t* __restrict upper_out = out + y * w, * __restrict u = u_out + y / 2 * half, * __restrict v = v_out + y / 2 * half;
    for (std::int64_t row = 0; row < 2 && y + row < h; ++row) {
      const std::uint8_t* __restrict from = rgba + 4 * w * (y + row);
      std::uint8_t* __restrict to = upper_out + row * w;
      for (std::int64_t x = 0; x < w; ++x) {
        std::uint32_t pixel;
        __builtin_memcpy(&pixel, from + 4 * x, sizeof pixel);
        to[x] = luma(pixel);
      }
    }
    if (y + 1 == h) break;
    const std::uint8_t* __restrict a = rgba + 4 * w * y;
    const std::uint8_t* __restrict b = a + 4 * w;
    for (std::int64_t x = 0; x < half; ++x) {
      std::uint64_t pa, pb;  // two pixels each
      __builtin_memcpy(&pa, a + 8 * x, sizeof pa);
      __builtin_memcpy(&pb, b + 8 * x, sizeof pb);
      // sums of four in fields of 16 bits: red and blue, green
      constexpr std::uint64_t kFields = 0x00ff00ff00ff00ff;
      const std::uint64_t red_blue = (pa & kFields) + (pb & kFields), green = (pa >> 8 & kFields) + (pb >> 8 & kFields);
      const int r = static_cast<int>((red_blue & 0xffff) + (red_blue >> 32 & 0xffff));
      const int g = static_cast<int>((green & 0xffff) + (green >> 32 & 0xffff));
      const int bl = static_cast<int>((red_blue >> 16 & 0xffff) + (red_blue >> 48));
      u[x] = static_cast<std::uint8_t>((-6596 * r - 22189 * g + 28785 * bl + 4 * kOne * 128 + 2 * kOne) >> 18);
      v[x] = static_cast<std::uint8_t>((28785 * r - 26145 * g - 2640 * bl + 4 * kOne * 128 + 2 * kOne) >> 18);
    }
  }
}

}  // namespace
}  // namespace render::shade
