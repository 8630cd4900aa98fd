#include "render/gl/noise.h"

#include <algorithm>

namespace render::gl {
namespace {

// one byte for a lattice point: the mixing function of a xorshift multiply hash
int hash(std::uint32_t x, std::uint32_t y, std::uint32_t layer) {
  std::uint32_t h = x * 0x9e3779b1u ^ (y * 0x85ebca77u + layer * 0xc2b2ae3du);
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 12;
  h *= 0x297a2d39u;
  h ^= h >> 15;
  return static_cast<int>(h & 255u);
}

// value noise of cell size `cell`, bilinear, tiling
int layer(int x, int y, int cell) {
  const int cells = kNoiseSize / cell;
  const int i = x / cell, j = y / cell, fx = x % cell, fy = y % cell;
  const auto at = [&](int a, int b) {
    return hash(static_cast<std::uint32_t>(a % cells), static_cast<std::uint32_t>(b % cells), static_cast<std::uint32_t>(cell));
  };
  const int low = at(i, j) * (cell - fx) + at(i + 1, j) * fx;
  const int high = at(i, j + 1) * (cell - fx) + at(i + 1, j + 1) * fx;
  return (low * (cell - fy) + high * fy) / (cell * cell);
}

}  // namespace

const std::vector<std::uint8_t>& grain_picture() {
  static const std::vector<std::uint8_t> grain = [] {
    std::vector<std::uint8_t> out;
    for (int y = 0; y < kNoiseSize; ++y)
      for (int x = 0; x < kNoiseSize; ++x) {
        const int sum =
            30 * layer(x, y, 1) + 26 * layer(x, y, 2) + 20 * layer(x, y, 4) + 12 * layer(x, y, 16) + 12 * layer(x, y, 64);
        out.push_back(static_cast<std::uint8_t>(std::clamp(sum / 100, 0, 255)));
      }
    return out;
  }();
  return grain;
}

}  // namespace render::gl
