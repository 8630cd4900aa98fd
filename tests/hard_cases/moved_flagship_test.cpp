// The flagship 100 km away, as in map coordinates: the same motion.
#include <gtest/gtest.h>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

using engine::Vec3;

constexpr const char* kFlagship = "scenes/cases/sedan_pedestrian_40kmh";

void move(engine::Model& model, const Vec3& by) {
  for (engine::Body& body : model.bodies) body.X_WB.p += by;
  for (engine::Joint& joint : model.joints)
    if (joint.parent < 0) joint.X_PF.p += by;
  if (!model.ground.terrain) return;
  std::vector<Vec3> vertices = model.ground.terrain->vertices();
  for (Vec3& v : vertices) v += by;
  model.ground.terrain = std::make_shared<engine::TriangleMesh>(std::move(vertices), model.ground.terrain->triangles());
}

/// The scene turned about the y axis through the origin, and under it a slope of triangles instead of the plane. Gravity stays.
void tilt(engine::Model& model, double angle) {
  const engine::Quat turn(Eigen::AngleAxisd(-angle, Vec3::UnitY()));  // +x is uphill
  for (engine::Body& body : model.bodies) {
    body.X_WB.q = turn * body.X_WB.q;
    body.X_WB.p = turn * body.X_WB.p;
    body.V_WB.v = turn * body.V_WB.v;
    body.V_WB.w = turn * body.V_WB.w;
  }
  constexpr int kSquares = 24;
  constexpr double kHalf = 60;  // [m]
  std::vector<Vec3> vertices;
  std::vector<engine::Triangle> triangles;
  for (int i = 0; i <= kSquares; ++i)
    for (int j = 0; j <= kSquares; ++j)
      vertices.push_back(turn * Vec3(kHalf * (2.0 * i / kSquares - 1), kHalf * (2.0 * j / kSquares - 1), 0));
  for (int i = 0; i < kSquares; ++i)
    for (int j = 0; j < kSquares; ++j) {
      const int a = i * (kSquares + 1) + j, b = a + kSquares + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  model.ground.plane = false;
  model.ground.terrain = std::make_shared<engine::TriangleMesh>(std::move(vertices), std::move(triangles));
}

double largest_distance(const engine::Recording& there, const engine::Recording& here, const Vec3& by, double until) {
  double worst = 0;
  for (std::size_t i = 0; i < here.snapshots.size() && here.snapshots[i].time < until + 1e-9; ++i)
    for (std::size_t b = 0; b < here.snapshots[i].bodies.size(); ++b)
      worst = std::max(worst, (there.snapshots[i].bodies[b].X_WB.p - by - here.snapshots[i].bodies[b].X_WB.p).norm());
  return worst;
}

class MovedFlagship : public testing::TestWithParam<Setting> {};
INSTANTIATE_TEST_SUITE_P(At, MovedFlagship, testing::ValuesIn(kSettings));

TEST_P(MovedFlagship, RunsAsAtTheOrigin) {
  const std::vector<std::string> one_second = {"simulation.duration=1 s"};
  const Outcome here = run(kFlagship, GetParam(), one_second);
  const Vec3 far{1e5, -3e4, 0};
  const Outcome there = run(kFlagship, GetParam(), one_second, [&](engine::Model& m) { move(m, far); });
  const double distance = largest_distance(there.recording, here.recording, far, 1);
  row("flagship at 100 km", there, "differs by %.1e m over the first second", distance);
  EXPECT_LT(distance, 1e-6);
}

TEST_P(MovedFlagship, RunsOnASlopeOfTrianglesAsAtTheOrigin) {
  const std::vector<std::string> one_second = {"simulation.duration=1 s"};
  const auto steep = [](engine::Model& m) { tilt(m, M_PI / 6); };
  const Outcome here = run(kFlagship, GetParam(), one_second, steep);
  const Vec3 far{1e5, -3e4, 0};
  const Outcome there = run(kFlagship, GetParam(), one_second, [&](engine::Model& m) {
    steep(m);
    move(m, far);
  });
  const double distance = largest_distance(there.recording, here.recording, far, 1);
  const bool struck = std::any_of(here.recording.snapshots.begin(), here.recording.snapshots.end(), [&](const engine::Snapshot& s) {
    return std::any_of(s.contacts.begin(), s.contacts.end(),
                       [&](const engine::ContactRecord& c) { return c.body_a >= 0 && c.body_b >= 0; });
  });
  row("flagship at 100 km on 30 deg", there, "differs by %.1e m over the first second, penetration %.2f mm, drift %.1e m", distance,
      1e3 * there.diagnostics().max_penetration, there.diagnostics().max_joint_gap);
  EXPECT_TRUE(struck);
  EXPECT_LT(distance, 1e-6);
  EXPECT_LT(there.diagnostics().max_penetration, 2e-3);
  EXPECT_LT(there.diagnostics().max_joint_gap, 1e-6);
}

}  // namespace
}  // namespace hard_cases
