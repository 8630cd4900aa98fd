// Long meshes that meet edge on edge, far from any of their vertices: they must not pass through each other.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/engine/experiment.h"
#include "tests/hard_cases/hard_case.h"
#include "tests/hard_cases/meshes.h"

namespace hard_cases {
namespace {

engine::Body bar(const char* name, const engine::Vec3& half, const engine::Vec3& at) {
  engine::Body body;
  body.name = name;
  body.mass = 40;
  body.inertia_B = engine::principal_inertia({half, 8}, body.mass).asDiagonal();
  body.shape = engine::MeshShape{box_mesh(half), {}};
  body.X_WB.p = at;
  body.surface.restitution_body = 0;
  return body;
}

class CrossedEdges : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(At, CrossedEdges, testing::Values(1.0, 5.0, 15.0));

TEST_P(CrossedEdges, CarryEachOther) {
  constexpr double kHalf = 0.15, kLength = 1.5, kTurned = 0.6;
  engine::Model model = engine::test::free_space(0.4);
  model.ground.plane = false;
  model.bodies = {bar("lower", {kHalf, kLength, kHalf}, {0, 0, 0}), bar("upper", {kLength, kHalf, kHalf}, {0, 0, 0.6})};
  // turned about their length: edge on edge
  model.bodies[0].X_WB.q = Eigen::AngleAxisd(kTurned, engine::Vec3::UnitY());
  model.bodies[1].X_WB.q = Eigen::AngleAxisd(kTurned, engine::Vec3::UnitX());
  model.bodies[1].V_WB.v.z() = -GetParam();
  model.settings.duration = 0.6 / GetParam();
  const engine::Recording it = engine::simulate(model);
  double depth = 0;
  for (const engine::Snapshot& s : it.snapshots)
    for (const engine::ContactRecord& c : s.contacts) depth = std::max(depth, c.depth);
  const auto& last = it.snapshots.back().bodies;
  // edge on edge they stand by their half diagonals; an edge is felt at points at most 10 cm apart
  const double touching = 2 * kHalf * (std::cos(kTurned) + std::sin(kTurned));
  const double apart = last[1].X_WB.p.z() - last[0].X_WB.p.z();
  row("crossed edges", fmt::format("at {:.0f} m/s", GetParam()), "edges %.0f mm past each other, points %.1f mm in",
      1e3 * (touching - apart), 1e3 * depth);
  EXPECT_GT(apart, touching - 0.1);
  // momentum is kept, and nothing is gained
  EXPECT_NEAR(last[0].V_WB.v.z() + last[1].V_WB.v.z(), -GetParam(), 1e-9 * GetParam());
  EXPECT_LE(energy(it.snapshots.back()), energy(it.snapshots.front()) * (1 + 1e-9));
}

}  // namespace
}  // namespace hard_cases
