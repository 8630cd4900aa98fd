#include "render/surface/tessellate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace render {
namespace {

using engine::Vec3;

/// Point of the unit cube's surface on a face, spaced by equal angles so that triangles stay alike in size.
Vec3 on_cube(int face, double u, double v) {
  const double a = std::tan(u * std::numbers::pi / 4), b = std::tan(v * std::numbers::pi / 4);
  switch (face) {
    case 0:
      return {1, a, b};
    case 1:
      return {-1, -a, b};
    case 2:
      return {-a, 1, b};
    case 3:
      return {a, -1, b};
    case 4:
      return {-b, a, 1};
    default:
      return {b, a, -1};
  }
}

}  // namespace

Tessellation tessellate(const engine::HyperEllipsoid& shape, int cells) {
  Tessellation out;
  std::map<std::array<long, 3>, std::uint32_t> known;  // faces share their borders
  auto vertex = [&](int face, int i, int j) {
    const Vec3 cube = on_cube(face, 2.0 * i / cells - 1, 2.0 * j / cells - 1);
    const Vec3 p = engine::radial_point(shape, shape.semi_axes.cwiseProduct(cube));
    const std::array<long, 3> key{std::lround(cube.x() * 1e6), std::lround(cube.y() * 1e6), std::lround(cube.z() * 1e6)};
    const auto [at, fresh] = known.emplace(key, static_cast<std::uint32_t>(out.positions.size() / 3));
    if (fresh) {
      const Vec3 n = engine::outward_normal(shape, p);
      for (int k = 0; k < 3; ++k) {
        out.positions.push_back(static_cast<float>(p[k]));
        out.normals.push_back(static_cast<float>(n[k]));
      }
    }
    return at->second;
  };
  for (int face = 0; face < 6; ++face)
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) {
        const std::uint32_t a = vertex(face, i, j), b = vertex(face, i + 1, j), c = vertex(face, i + 1, j + 1),
                            d = vertex(face, i, j + 1);
        for (const std::uint32_t index : {a, b, c, a, c, d}) out.indices.push_back(index);
      }
  return out;
}

double largest_gap(const engine::HyperEllipsoid& shape, const Tessellation& t) {
  auto vertex = [&](std::size_t corner) {
    const std::size_t v = 3 * std::size_t{t.indices[corner]};
    return Vec3(t.positions[v], t.positions[v + 1], t.positions[v + 2]);
  };
  double gap = 0;
  for (std::size_t i = 0; i < t.indices.size(); i += 3) {
    const Vec3 a = vertex(i), b = vertex(i + 1), c = vertex(i + 2);
    for (const Vec3& x : {Vec3((a + b + c) / 3), Vec3((a + b) / 2), Vec3((b + c) / 2), Vec3((c + a) / 2)})
      gap = std::max(gap, x.norm() * std::abs(1 / engine::gauge(shape, x) - 1));
  }
  return gap;
}

int cells_for(const engine::HyperEllipsoid& shape, double tolerance) {
  constexpr std::array<int, 7> kLevels{6, 8, 12, 16, 24, 36, 56};
  for (const int cells : kLevels)
    if (largest_gap(shape, tessellate(shape, cells)) <= tolerance) return cells;
  return kLevels.back();
}

}  // namespace render
