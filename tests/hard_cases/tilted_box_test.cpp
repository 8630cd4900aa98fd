// Almost a box, resting and rocking: its lowest point jumps across the face with a tilt of a millionth.
#include <gtest/gtest.h>

#include "engine/geometry/hyper_ellipsoid.h"
#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

class TiltedBox : public testing::TestWithParam<std::tuple<double, Setting>> {};
INSTANTIATE_TEST_SUITE_P(By, TiltedBox, testing::Combine(testing::Values(1e-6, 1e-4, 1e-3, 1e-2), testing::ValuesIn(kSettings)));

TEST_P(TiltedBox, NeitherHumsNorCreepsNorSinks) {
  const auto [tilt, setting] = GetParam();
  const Outcome it = run("tilted_box", setting, {}, [tilt = tilt](engine::Model& model) {
    engine::Body& box = model.bodies[0];
    box.X_WB.q = engine::Quat(Eigen::AngleAxisd(tilt, engine::Vec3(0.6, 0.8, 0)));
    const auto& shape = std::get<engine::HyperEllipsoid>(box.shape);
    box.X_WB.p.z() = support_value(shape, box.X_WB.q.conjugate() * -engine::Vec3::UnitZ());
  });
  const engine::BodyState settled = it.recording.at(1).bodies[0];
  const double creep = (it.last(0).X_WB.p - settled.X_WB.p).norm();
  double force = 0;
  for (const engine::ContactRecord& c : it.recording.snapshots.back().contacts) force += c.normal_force;
  const double weight = it.model.bodies[0].mass * engine::kGravity;
  const auto& d = it.diagnostics();
  row("tilted box, n = 30", it, "%.0e rad: after 1 s %.1e m/s, %.1e rad/s; creep in 10 s %.1e m; N/mg %.4f; penetration %.2f mm",
      tilt, settled.V_WB.v.norm(), settled.V_WB.w.norm(), creep, force / weight, d.max_penetration * 1e3);
  EXPECT_LT(settled.V_WB.v.norm(), 1e-3);
  EXPECT_LT(settled.V_WB.w.norm(), 0.01);
  EXPECT_LT(creep, 1e-4);
  EXPECT_NEAR(force / weight, 1, 0.01);
  EXPECT_LT(d.max_penetration, 5e-4);
  EXPECT_GE(d.rest_penetration, 0);
}

}  // namespace
}  // namespace hard_cases
