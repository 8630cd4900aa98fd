// Coarser levels of a mesh: fewer triangles, still closed, within their tolerance of the surface.
#include "render/surface/simplify.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "render/surface/tessellate.h"

namespace render {
namespace {

Mesh ball(double radius, int cells) {
  const Tessellation t = tessellate({Vec3::Constant(radius), 2}, cells);
  Mesh m;
  m.positions = t.positions;
  m.normals = t.normals;
  m.indices = t.indices;
  return m;
}

Vec3 vertex(const Mesh& m, std::uint32_t v) {
  return {m.positions[3 * std::size_t{v}], m.positions[3 * std::size_t{v} + 1], m.positions[3 * std::size_t{v} + 2]};
}

TEST(Simplify, OfABallStaysClosedAndWithinItsTolerance) {
  const Mesh m = ball(0.5, 40);
  const auto levels = coarser_levels(m);
  ASSERT_FALSE(levels.empty());
  const std::vector<std::uint32_t> place = welded(m);
  std::size_t before = m.indices.size();
  for (const Mesh::Level& level : levels) {
    SCOPED_TRACE(level.tolerance);
    EXPECT_LE(level.indices.size(), before);
    before = level.indices.size();
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t t = 0; t < level.indices.size(); t += 3) {
      Vec3 middle = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        ++edges[{place[level.indices[t + k]], place[level.indices[t + (k + 1) % 3]]}];
        middle += vertex(m, level.indices[t + k]) / 3;
      }
      // corners lie on the ball, so a triangle dips below it most at its middle. The bound holds for planes of the fine triangles
      // at kept corners; between these a chord dips as much again
      EXPECT_GT(middle.norm(), 0.5 - 2.5 * level.tolerance - 1e-3);
    }
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1);
      ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
  }
  EXPECT_LT(levels.back().indices.size(), m.indices.size() / 8) << "16 mm on a ball of a metre needs few triangles";
}

TEST(Simplify, KeepsTheBorderBetweenParts) {
  // two halves of a flat square: inside each all is flat and may go, the line between them must stay straight at x = 0
  Mesh m;
  constexpr int kSide = 32;
  for (int j = 0; j <= kSide; ++j)
    for (int i = 0; i <= kSide; ++i) {
      m.positions.insert(m.positions.end(), {static_cast<float>(i - kSide / 2), static_cast<float>(j), 0.0f});
      m.normals.insert(m.normals.end(), {0, 0, 1});
    }
  for (int half = 0; half < 2; ++half) {
    const auto first = static_cast<std::uint32_t>(m.indices.size());
    for (int j = 0; j < kSide; ++j)
      for (int i = half * kSide / 2; i < (half + 1) * kSide / 2; ++i) {
        const auto a = static_cast<std::uint32_t>(j * (kSide + 1) + i);
        const std::uint32_t b = a + 1, c = a + kSide + 1, d = c + 1;
        m.indices.insert(m.indices.end(), {a, b, d, a, d, c});
      }
    m.parts.push_back({first, static_cast<std::uint32_t>(m.indices.size()) - first, half});
  }
  const auto levels = coarser_levels(m);
  ASSERT_FALSE(levels.empty());
  const Mesh::Level& level = levels.front();
  EXPECT_LT(level.indices.size(), m.indices.size() / 10);
  for (std::size_t half = 0; half < 2; ++half) {
    double area = 0;
    for (std::uint32_t t = level.parts[half].first; t < level.parts[half].first + level.parts[half].count; t += 3) {
      const Vec3 a = vertex(m, level.indices[t]), b = vertex(m, level.indices[t + 1]), c = vertex(m, level.indices[t + 2]);
      area += (b - a).cross(c - a).z() / 2;
    }
    // whole numbers throughout
    EXPECT_DOUBLE_EQ(area, kSide * kSide / 2);
  }
}

}  // namespace
}  // namespace render
