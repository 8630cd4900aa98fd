#include "render/gl/light_pass.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

namespace render::gl {
namespace {

constexpr int kAlike = 4588;  // of 65535: normals within some 15 degrees

/// Of some of a pixel's four samples: their share of it, and their middle, counted from the first sample [pixels].
struct Middle {
  float share, right, up;
};
constexpr std::array<Middle, 16> kMiddles = [] {
  std::array<Middle, 16> out{};
  for (unsigned set = 1; set < 16; ++set) {
    const float count = static_cast<float>(std::popcount(set)), per = 0.5f / count;
    out[set] = {count / 4, static_cast<float>(std::popcount(set & 10)) * per, static_cast<float>(std::popcount(set & 12)) * per};
  }
  return out;
}();

}  // namespace

void LightPass::draw(const Lighting& lighting, ObjectPass& objects, const shade::Canvas& canvas) {
  if (count_ == 0) return;
  shade::kernels().surfaces(
      lighting.data, lighting.maps,
      {lighting.materials, triangles_, objects.triangles().corners(), static_cast<float>(lighting.samples), lighting.terrain},
      {static_cast<int>(count_), x_.data(), y_.data(), triangle_.data(), red_.data(), green_.data(), blue_.data()});
  lay(canvas);
}

void LightPass::add(float share, float x, float y, int pixel, std::int32_t triangle) {
  pixel_[count_] = pixel;
  share_[count_] = share;
  x_[count_] = x;
  y_[count_] = y;
  triangle_[count_++] = triangle;
}

void LightPass::find(ObjectPass& objects, const Rectangle& r, int samples, const shade::Canvas& canvas, std::uint8_t* covered) {
  count_ = 0;
  const std::size_t most = 2 * static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height) + 7;
  if (pixel_.size() < most) {
    for (auto* list : {&share_, &x_, &y_, &red_, &green_, &blue_}) list->resize(most, 0.5f);
    pixel_.resize(most);
    triangle_.resize(most);
  }
  triangles_ = objects.triangles().described().data();
  const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(r.width) * samples;
  for (int y = r.y; y < r.y + r.height; ++y) {
    std::uint8_t* const of_row = covered + static_cast<std::ptrdiff_t>(y) * canvas.width;
    std::fill_n(of_row, canvas.width, std::uint8_t{0});
    const std::int32_t* low = objects.names() + (y - r.y) * samples * row;
    const int first = static_cast<int>(y * canvas.pitch) + r.x;
    for (int x = 0; x < r.width; ++x, low += samples) {
      const Seen seen = samples == 2 ? Seen{low[0], low[1], low[row], low[row + 1]} : Seen{low[0], low[0], low[0], low[0]};
      if ((seen[0] | seen[1] | seen[2] | seen[3]) == 0) continue;
      of_row[r.x + x] = seen[0] != 0 && seen[1] != 0 && seen[2] != 0 && seen[3] != 0 ? 255 : 0;
      const float px = static_cast<float>(r.x + x), py = static_cast<float>(y);
      if (seen[0] == seen[1] && seen[0] == seen[2] && seen[0] == seen[3])  // mostly
        add(1, px + 0.5f, py + 0.5f, first + x, seen[0]);
      else
        add_edge(seen, first + x, px, py);
    }
  }
  // what fills up the last eight looks like the last
  for (std::size_t i = count_; i < count_ + 7 && count_ > 0; ++i) triangle_[i] = triangle_[count_ - 1];
}

/// One surface: the same material, normals close to each other. At the octahedron's folds a surface may look like two; that costs
/// time alone.
bool LightPass::same(std::int32_t one, std::int32_t other) const {
  if (one == 0 || other == 0) return false;
  const shade::Triangle &a = triangles_[one], &b = triangles_[other];
  return a.row == b.row && std::abs((a.facing & 0xffff) - (b.facing & 0xffff)) < kAlike &&
         std::abs((a.facing >> 16 & 0xffff) - (b.facing >> 16 & 0xffff)) < kAlike;
}

/// The samples of a pixel show one surface, or two: nearly no pixel shows three, and the third then looks like the second. A
/// surface is looked at in the middle of those samples that show one and the same of its triangles, so the place lies within that
/// triangle: beside it, where a surface is seen from its edge, the depth would be far off and the surface would shade itself.
void LightPass::add_edge(const Seen& seen, int pixel, float x, float y) {
  const auto those = [&seen](auto&& are) {
    unsigned out = 0;
    for (unsigned k = 0; k < 4; ++k) out |= are(seen[k]) ? 1u << k : 0u;
    return out;
  };
  unsigned left = those([](std::int32_t name) { return name != 0; });
  for (int surface = 0; surface < 2 && left != 0; ++surface) {
    const std::int32_t name = seen[static_cast<std::size_t>(std::countr_zero(left))];
    const unsigned exactly = those([name](std::int32_t other) { return other == name; });
    const unsigned mine = those([&](std::int32_t other) { return other == name || same(name, other); }) & left;
    const Middle& middle = kMiddles[exactly];
    add(kMiddles[surface == 0 ? mine : left].share, x + 0.25f + middle.right, y + 0.25f + middle.up, pixel, name);
    left &= ~mine;
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

}  // namespace render::gl
