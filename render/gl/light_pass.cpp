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
  const std::vector<shade::Triangle>& triangles = objects.sampler().triangles();
  find_surfaces(lighting, objects, triangles, r, canvas.pitch);
  if (count_ == 0) return;
  shade::kernels().surfaces(
      lighting.data, lighting.maps,
      {lighting.materials, triangles.data(), objects.sampler().vertices(), static_cast<float>(lighting.samples), lighting.terrain},
      {static_cast<int>(count_), x_.data(), y_.data(), z_.data(), triangle_.data(), red_.data(), green_.data(), blue_.data()});
  lay(canvas);
}

void LightPass::make_room(std::size_t more) {
  constexpr std::size_t kRoom = 7;
  const std::size_t wanted = count_ + more + kRoom;
  if (pixel_.size() >= wanted) return;
  const std::size_t size = std::max(wanted, 3 * pixel_.size() / 2);
  for (auto* list : {&share_, &x_, &y_, &z_, &red_, &green_, &blue_}) list->resize(size, 0.5f);
  pixel_.resize(size);
  triangle_.resize(size);
}

void LightPass::find_surfaces(const Lighting& lighting, const ObjectPass& objects, const std::vector<shade::Triangle>& triangles,
                              const Rectangle& r, std::ptrdiff_t pitch) {
  count_ = 0;
  const int s = lighting.samples;
  const std::ptrdiff_t w = r.width * s;
  for (int y = 0; y < r.height; ++y) {
    make_room(2 * static_cast<std::size_t>(r.width));
    const float* low = objects.depth() + y * s * w;
    for (int x = 0; x < r.width; ++x, low += s) {
      bool empty = low[0] >= 1;
      if (s == 2) empty = empty && low[1] >= 1 && low[w] >= 1 && low[w + 1] >= 1;
      if (!empty)
        add_pixel(objects, triangles, s, low - objects.depth(), w, static_cast<std::int32_t>((r.y + y) * pitch) + r.x + x,
                  static_cast<float>(r.x + x), static_cast<float>(r.y + y));
    }
  }
  // what fills up the last eight looks like the last
  for (std::size_t i = count_; i < count_ + 7 && count_ > 0; ++i) triangle_[i] = triangle_[count_ - 1];
}

/// The samples of a pixel show one surface, or two: nearly no pixel shows three, and the third then looks like the second.
void LightPass::add_pixel(const ObjectPass& objects, const std::vector<shade::Triangle>& triangles, int samples,
                          std::ptrdiff_t corner, std::ptrdiff_t row, int pixel, float x, float y) {
  const int all = samples * samples;
  const std::array<std::ptrdiff_t, 4> at{corner, corner + 1, corner + row, corner + row + 1};
  const float* const depth = objects.depth();
  const std::int32_t* const names = objects.names();
  const auto add = [&](float share, float right, float up, float z, std::int32_t name) {
    pixel_[count_] = pixel;
    share_[count_] = share;
    x_[count_] = x + right;
    y_[count_] = y + up;
    z_[count_] = z;
    triangle_[count_++] = name;
  };
  if (samples == 2) {  // mostly
    const std::int32_t name = names[corner];
    const float farthest = std::max(std::max(depth[at[0]], depth[at[1]]), std::max(depth[at[2]], depth[at[3]]));
    const shade::Triangle& first = triangles[static_cast<std::size_t>(farthest < 1 ? name : 0)];
    const auto same = [&](std::size_t k) {
      const std::int32_t other = names[at[k]];
      return other == name || alike(first, triangles[static_cast<std::size_t>(other)]);
    };
    if (farthest < 1 && same(1) && same(2) && same(3)) {
      add(1, 0.5f, 0.5f, (depth[at[0]] + depth[at[1]] + depth[at[2]] + depth[at[3]]) * 0.25f, name);
      return;
    }
  }
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
    const int covered = surface == 0 ? n : std::popcount(left);
    add(static_cast<float>(covered) / static_cast<float>(all), sample * (0.5f + static_cast<float>(right) * per),
        sample * (0.5f + static_cast<float>(up) * per), z * per, name);
    left &= ~same;
  }
}

void LightPass::lay(const shade::Canvas& canvas) const {
  for (std::size_t i = 0; i < count_;) {
    const int pixel = pixel_[i];
    std::uint8_t* out = canvas.pixels + 4 * static_cast<std::ptrdiff_t>(pixel);
    out[3] = 255;
    if (share_[i] == 1) {  // mostly
      for (const std::size_t k : {0u, 1u, 2u})
        out[k] = static_cast<std::uint8_t>(255 * std::clamp((k == 0 ? red_ : k == 1 ? green_ : blue_)[i], 0.0f, 1.0f) + 0.5f);
      ++i;
      continue;
    }
    float left = 1;
    std::array<float, 3> sum{};
    do {
      const std::array<float, 3> c{red_[i], green_[i], blue_[i]};
      for (std::size_t k = 0; k < 3; ++k) sum[k] += share_[i] * 255 * std::clamp(c[k], 0.0f, 1.0f);
      left -= share_[i++];
    } while (i < count_ && pixel_[i] == pixel);
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
