// The flagship 100 km away, and on a terrain of 30 deg: the same motion in other axes.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/hard_cases/hard_case.h"
#include "tests/hard_cases/meshes.h"

namespace hard_cases {
namespace {

using engine::Pose;
using engine::Quat;
using engine::Vec3;

constexpr const char* kFlagship = "scenes/cases/sedan_pedestrian_40kmh";

/// Everything placed as X_NW says: bodies, velocities, joints to the world, gravity; the ground as a terrain of two triangles.
void move(engine::Model& model, const Pose& X_NW, bool terrain) {
  for (engine::Body& body : model.bodies) {
    body.X_WB = X_NW * body.X_WB;
    body.V_WB.v = X_NW.q * body.V_WB.v;
    body.V_WB.w = X_NW.q * body.V_WB.w;
  }
  for (engine::Joint& joint : model.joints)
    if (joint.parent < 0) joint.X_PF = X_NW * joint.X_PF;
  model.settings.gravity = X_NW.q * model.settings.gravity;
  if (!terrain) return;
  Sheet sheet = flat_sheet(-200, 200, -200, 200, 1, 1);
  for (Vec3& v : sheet.vertices) v = X_NW * v;
  model.ground.plane = false;
  model.ground.terrain = std::make_shared<engine::TriangleMesh>(sheet.vertices, sheet.triangles);
}

double largest_distance(const engine::Recording& there, const engine::Recording& here, const Pose& X_NW, double until) {
  double worst = 0;
  for (std::size_t i = 0; i < here.snapshots.size() && here.snapshots[i].time < until + 1e-9; ++i)
    for (std::size_t b = 0; b < here.snapshots[i].bodies.size(); ++b)
      worst = std::max(worst, (X_NW.inverse() * there.snapshots[i].bodies[b].X_WB.p - here.snapshots[i].bodies[b].X_WB.p).norm());
  return worst;
}

class MovedFlagship : public testing::TestWithParam<Setting> {};
INSTANTIATE_TEST_SUITE_P(At, MovedFlagship, testing::ValuesIn(kSettings));

TEST_P(MovedFlagship, RunsAsAtTheOrigin) {
  const std::vector<std::string> one_second = {"simulation.duration=1 s"};
  const Outcome here = run(kFlagship, GetParam(), one_second);
  const Pose far{{1e5, 0, 0}, Quat::Identity()};
  const Outcome there = run(kFlagship, GetParam(), one_second, [&](engine::Model& m) { move(m, far, false); });
  const double distance = largest_distance(there.recording, here.recording, far, 1);
  row("flagship at 100 km", there, "differs by %.1e m over the first second", distance);
  EXPECT_LT(distance, 1e-6);

  const Pose tilted{Vec3::Zero(), Quat(Eigen::AngleAxisd(std::numbers::pi / 6, Vec3(0.6, 0.8, 0)))};
  const Outcome slope = run(kFlagship, GetParam(), one_second, [&](engine::Model& m) { move(m, tilted, true); });
  const double on_slope = largest_distance(slope.recording, here.recording, tilted, 1);
  row("flagship on 30 deg", slope, "differs by %.1e m over the first second", on_slope);
  EXPECT_LT(on_slope, 1e-6);
}

}  // namespace
}  // namespace hard_cases
