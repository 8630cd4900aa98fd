#include "render/gl/light_pass.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

namespace render::gl {
namespace {

constexpr int kAlike = 4588;  // of 65535: normals within some 15 degrees

/// One surface: the same material, normals close to each other. At the octahedron's folds a surface may look like two; that costs
/// time alone.
bool alike(const shade::Triangle& a, const shade::Triangle& b) {
  return a.row == b.row && std::abs((a.facing & 0xffff) - (b.facing & 0xffff)) < kAlike &&
         std::abs((a.facing >> 16 & 0xffff) - (b.facing >> 16 & 0xffff)) < kAlike;
}

}  // namespace

void LightPass::draw(const Lighting& lighting, ObjectPass& objects, const Rectangle& r, const shade::Canvas& canvas) {
  if (r.width <= 0 || r.height <= 0) return;
  for (auto* list : {&share_, &x_, &y_, &z_}) list->clear();
  pixel_.clear();
  triangle_.clear();
  const std::vector<shade::Triangle>& triangles = objects.sampler().triangles();
  find_surfaces(lighting, objects, triangles, r);
  if (pixel_.empty()) return;
  const std::size_t count = pixel_.size(), room = count + 7;
  for (auto* list : {&x_, &y_, &z_, &red_, &green_, &blue_}) list->resize(room, 0.5f);
  triangle_.resize(room, 0);
  shade::kernels().surfaces(
      lighting.data, lighting.maps,
      {lighting.materials, triangles.data(), objects.sampler().vertices(), static_cast<float>(lighting.samples), lighting.terrain},
      {static_cast<int>(count), x_.data(), y_.data(), z_.data(), triangle_.data(), red_.data(), green_.data(), blue_.data()});
  lay(r, canvas);
}

void LightPass::find_surfaces(const Lighting& lighting, const ObjectPass& objects, const std::vector<shade::Triangle>& triangles,
                              const Rectangle& r) {
  const int s = lighting.samples, w = r.width * s;
  for (int y = 0; y < r.height; ++y) {
    const float* low = objects.depth() + static_cast<std::ptrdiff_t>(y * s) * w;
    for (int x = 0; x < r.width; ++x, low += s) {
      bool empty = low[0] >= 1;
      if (s == 2) empty = empty && low[1] >= 1 && low[w] >= 1 && low[w + 1] >= 1;
      if (!empty) add_pixel(lighting, objects, triangles, r, x, y);
    }
  }
}

/// The samples of a pixel show one surface, or two: nearly no pixel shows three, and the third then looks like the second.
void LightPass::add_pixel(const Lighting& lighting, const ObjectPass& objects, const std::vector<shade::Triangle>& triangles,
                          const Rectangle& r, int x, int y) {
  const int samples = lighting.samples, all = samples * samples;
  const std::ptrdiff_t w = r.width * samples, corner = static_cast<std::ptrdiff_t>(y * samples) * w + x * samples;
  const std::array<std::ptrdiff_t, 4> at{corner, corner + 1, corner + w, corner + w + 1};
  const float* const depth = objects.depth();
  const std::int32_t* const names = objects.names();
  unsigned left = 0;
  for (int k = 0; k < all; ++k) left |= depth[at[static_cast<std::size_t>(k)]] < 1 ? 1u << k : 0u;
  for (int surface = 0; surface < 2 && left != 0; ++surface) {
    const int first = std::countr_zero(left);
    const std::int32_t name = names[at[static_cast<std::size_t>(first)]];
    const shade::Triangle& a = triangles[static_cast<std::size_t>(name)];
    unsigned same = 0;
    int right = 0, up = 0, n = 0;
    float z = 0;
    for (int k = first; k < all; ++k) {
      const std::int32_t other = names[at[static_cast<std::size_t>(k)]];
      if (!(left >> k & 1) || (other != name && !alike(a, triangles[static_cast<std::size_t>(other)]))) continue;
      same |= 1u << k;
      ++n;
      z += depth[at[static_cast<std::size_t>(k)]];
      right += k & 1;
      up += k >> 1;
    }
    const float per = 1.0f / static_cast<float>(n), sample = 1.0f / static_cast<float>(samples);
    pixel_.push_back(y * r.width + x);
    const int covered = surface == 0 ? n : std::popcount(left);
    share_.push_back(static_cast<float>(covered) / static_cast<float>(all));
    x_.push_back(static_cast<float>(r.x + x) + sample * (0.5f + static_cast<float>(right) * per));
    y_.push_back(static_cast<float>(r.y + y) + sample * (0.5f + static_cast<float>(up) * per));
    z_.push_back(z * per);
    triangle_.push_back(name);
    left &= ~same;
  }
}

void LightPass::lay(const Rectangle& r, const shade::Canvas& canvas) const {
  for (std::size_t i = 0; i < pixel_.size();) {
    const int pixel = pixel_[i], x = r.x + pixel % r.width, y = r.y + pixel / r.width;
    std::uint8_t* out = canvas.pixels + 4 * (static_cast<std::ptrdiff_t>(y) * canvas.width + x);
    float left = 1;
    std::array<float, 3> sum{};
    for (; i < pixel_.size() && pixel_[i] == pixel; ++i) {
      const std::array<float, 3> c{red_[i], green_[i], blue_[i]};
      for (std::size_t k = 0; k < 3; ++k) sum[k] += share_[i] * 255 * std::clamp(c[k], 0.0f, 1.0f);
      left -= share_[i];
    }
    for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<std::uint8_t>(sum[k] + left * static_cast<float>(out[k]) + 0.5f);
  }
}

void nearest_depths(const ObjectPass& objects, const Rectangle& r, int samples, int width, std::vector<float>& out) {
  const std::ptrdiff_t w = r.width * samples;
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x) {
      const float* low = objects.depth() + static_cast<std::ptrdiff_t>(y * samples) * w + x * samples;
      float nearest = low[0];
      if (samples == 2) nearest = std::min({nearest, low[1], low[w], low[w + 1]});
      out[static_cast<std::size_t>(r.y + y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(r.x + x)] = nearest;
    }
}

}  // namespace render::gl
