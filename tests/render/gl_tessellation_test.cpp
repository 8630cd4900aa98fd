// The triangles of a hyper-ellipsoid: closed, turned outward, near the surface.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "render/surface/tessellate.h"

namespace render {
namespace {

using engine::HyperEllipsoid;
using engine::Vec3;

Vec3 vertex(const Tessellation& t, std::size_t corner) {
  const std::size_t v = 3 * std::size_t{t.indices[corner]};
  return {t.positions[v], t.positions[v + 1], t.positions[v + 2]};
}

class TessellationOf : public testing::TestWithParam<double> {
 protected:
  HyperEllipsoid shape{Vec3(0.12, 0.2, 0.31), GetParam()};
};

TEST_P(TessellationOf, IsClosedAndTurnedOutward) {
  const Tessellation t = tessellate(shape, 12);
  // closed and of one turn: each directed edge once, and its opposite once
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i < t.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t.indices[i + k], t.indices[i + (k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  // a convex body around the origin: every face looks away from it, and so do the normals
  for (std::size_t i = 0; i < t.indices.size(); i += 3) {
    const Vec3 a = vertex(t, i), b = vertex(t, i + 1), c = vertex(t, i + 2);
    ASSERT_GT((b - a).cross(c - a).dot(a), 0);
  }
  for (std::size_t v = 0; v < t.positions.size(); v += 3)
    ASSERT_GT(t.positions[v] * t.normals[v] + t.positions[v + 1] * t.normals[v + 1] + t.positions[v + 2] * t.normals[v + 2], 0);
}

TEST_P(TessellationOf, HasItsVerticesOnTheSurfaceAndAlmostItsVolume) {
  const Tessellation t = tessellate(shape, 40);
  double volume = 0;
  for (std::size_t i = 0; i < t.indices.size(); i += 3) volume += vertex(t, i).dot(vertex(t, i + 1).cross(vertex(t, i + 2))) / 6;
  // floats hold the positions to 6e-8; the gauge multiplies that by n at most n times over the axes' ratio
  for (std::size_t v = 0; v < t.positions.size(); v += 3)
    ASSERT_NEAR(engine::gauge(shape, {t.positions[v], t.positions[v + 1], t.positions[v + 2]}), 1, 1e-6);
  // inscribed: never more; a grid of h = pi / 80 rad a cell loses about h^2 / 2 of each width, three widths, and rounder edges n
  // times that
  const double h = std::numbers::pi / 80, exact = engine::volume(shape);
  EXPECT_LT(volume, exact * (1 + 1e-6));
  EXPECT_GT(volume, exact * (1 - 1.5 * h * h * std::min(shape.exponent, 10.0)));
}

TEST_P(TessellationOf, StaysWithinTheToleranceAskedFor) {
  const double tolerance = 8e-4;  // [m] of quality `standard`
  const Tessellation t = tessellate(shape, cells_for(shape, tolerance));
  double gap = 0;
  for (std::size_t i = 0; i < t.indices.size(); i += 3) {
    const Vec3 a = vertex(t, i), b = vertex(t, i + 1), c = vertex(t, i + 2);
    // the radial gap is never smaller than the true one
    for (const Vec3& x : {Vec3((a + b + c) / 3), Vec3((a + b) / 2), Vec3((b + c) / 2), Vec3((c + a) / 2)})
      gap = std::max(gap, x.norm() * (1 / engine::gauge(shape, x) - 1));
  }
  EXPECT_LE(gap, tolerance);
}

INSTANTIATE_TEST_SUITE_P(Exponents, TessellationOf, testing::Values(2.0, 2.5, 4.0, 8.0));

}  // namespace
}  // namespace render
