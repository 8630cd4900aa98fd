// Meshes on meshes: how a flat panel or a straight edge is cut into triangles must not be felt.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/geometry/point_mesh.h"
#include "tests/engine/experiment.h"
#include "tests/engine/hand_made_runs.h"

namespace engine::test {
namespace {

/// A block of the half widths given whose twelve triangles lie the one way or the other.
std::shared_ptr<const TriangleMesh> block(const Vec3& half, bool other_way) {
  const auto one = box(-half, half);
  if (!other_way) return one;
  // mirrored it has the other diagonal of each side
  std::vector<Vec3> vertices = one->vertices();
  for (Vec3& v : vertices) v.x() = -v.x();
  std::vector<Triangle> triangles = one->triangles();
  for (Triangle& t : triangles) std::swap(t[1], t[2]);
  return std::make_shared<TriangleMesh>(vertices, triangles);
}

Body block_at(const std::shared_ptr<const TriangleMesh>& mesh, double mass, const Vec3& at) {
  const Vec3 half = mesh->bounds().upper;
  Body body = inert(mass, mass / 3 * Vec3(half.array().square().sum() - half.array().square()), at);
  body.shape = MeshShape{mesh, {}};
  return body;
}

Body fixed_block(const Vec3& half, bool other_way, const Vec3& at) {
  Body body = block_at(block(half, other_way), 1, at);
  body.name = "slab";
  body.fixed = true;
  return body;
}

/// v^2 / (2 mu g), over both diagonals of the slab.
TEST(MeshPair, ABlockSlidesOverASlabAsOverAPlane) {
  constexpr double kFriction = 0.5;
  const Vec3 v(10, 1, 0);
  for (const bool other_way : {false, true}) {
    Model model = free_space(2.5);
    model.settings.gravity = {0, 0, -kGravity};
    model.bodies = {block_at(block({0.4, 0.3, 0.2}, false), 50, {-3, -1.5, 0.2}),
                    fixed_block({30, 15, 0.5}, other_way, {9, 0, -0.5})};
    model.bodies[0].V_WB.v = v;
    for (Body& body : model.bodies) body.surface.friction_body = kFriction;
    const Vec3 from = model.bodies[0].X_WB.p;
    const Vec3 way = simulate(model).snapshots.back().bodies[0].X_WB.p - from;
    // a step more or less at 10 m/s
    EXPECT_NEAR(way.norm(), v.squaredNorm() / (2 * kFriction * kGravity), 0.01) << other_way;
    EXPECT_NEAR(way.y() / way.x(), v.y() / v.x(), 1e-3);
    EXPECT_NEAR(way.z(), 0, 1e-4);
  }
}

/// What comes upon a wall at a slant keeps (1 - mu tan) of its way along it, whichever way the wall is cut and however low it is.
TEST(MeshPair, ABlockIsTurnedByAWallAndNotHeldByItsEdges) {
  constexpr double kFriction = 0.2;
  const Vec3 v(20, 6, 0);
  for (const bool other_way : {false, true})
    for (const double top : {0.1, 2.0}) {  // above the middle of the block
      Model model = free_space(1);
      model.bodies = {block_at(block({0.4, 0.3, 0.2}, false), 50, {0, 0, 0}),
                      fixed_block({55, 0.15, 1.5}, other_way, {45, 2.65, top - 1.5})};
      // it keeps its attitude: no arm of the impulse
      model.bodies[0].inertia_B = Vec3::Constant(1e6).asDiagonal();
      model.bodies[0].V_WB.v = v;
      for (Body& body : model.bodies) body.surface.friction_body = kFriction;
      const Twist V = simulate(model).snapshots.back().bodies[0].V_WB;
      EXPECT_NEAR(V.v.x(), v.x() - kFriction * v.y(), 0.02) << other_way << ' ' << top;
      EXPECT_NEAR(V.v.y(), 0, 0.02);
      EXPECT_NEAR(V.v.z(), 0, 0.02);
    }
}

TEST(MeshPair, PointsPressBetweenTheNormalsOfTheirFaces) {
  const auto points = representative_points(*block({3, 2, 1}, true), 0.1, PointsOf::vertices_and_edges, WithNormals::yes);
  int corners = 0, edges = 0;
  for (const RepresentativePoint& point : points) {
    int at_bound = 0;
    for (int k = 0; k < 3; ++k) at_bound += std::abs(point.p[k]) == Vec3(3, 2, 1)[k] ? 1 : 0;
    ASSERT_GE(at_bound, 2) << "none within a flat side";
    EXPECT_EQ(point.normals.size(), static_cast<std::size_t>(at_bound));
    (at_bound == 3 ? corners : edges) += 1;
  }
  EXPECT_EQ(corners, 8);
  EXPECT_GT(edges, 4 * (50 + 30 + 10));
}

/// By geometry: a quadrant, a ray, an octant.
TEST(NearestInCone, IsTheProjection) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ(), d = Vec3(0.6, 0, 0.8);
  EXPECT_TRUE(nearest_in_cone({x}, d).isApprox(0.6 * x));
  EXPECT_TRUE(nearest_in_cone({-x}, d).isZero());
  EXPECT_TRUE(nearest_in_cone({x, z}, d).isApprox(d));
  EXPECT_TRUE(nearest_in_cone({x, y}, d).isApprox(0.6 * x));
  EXPECT_TRUE(nearest_in_cone({x, y, z}, Vec3(1, 2, 2) / 3).isApprox(Vec3(1, 2, 2) / 3));
  EXPECT_TRUE(nearest_in_cone({x, y, z}, Vec3(-1, 2, 2) / 3).isApprox(Vec3(0, 2, 2) / 3));
  EXPECT_TRUE(nearest_in_cone({x, y, z}, Vec3(-1, -2, 2) / 3).isApprox(Vec3(0, 0, 2) / 3));
}

/// One warning of two that stand in each other, and no promise that they part.
TEST(MeshPair, WhoStandsDeepInAnotherIsToldOnce) {
  Model model = free_space(0.01);
  model.settings.record_interval = 1e-3;
  const Vec3 half(1, 1, 1);
  model.bodies = {block_at(block(half, false), 50, {0, 0, 0}), block_at(block(half, true), 50, {1.88, 0.3, 0.3})};
  model.bodies[1].name = "other";
  EXPECT_THAT(simulate(model).diagnostics.warnings, testing::ElementsAre(testing::HasSubstr("a run does not part")));
}

}  // namespace
}  // namespace engine::test
