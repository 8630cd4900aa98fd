// A light limb flung about its middle axis, which is unstable, free and on its joint.
#include <gtest/gtest.h>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

using engine::Vec3;

class SpinningLimb : public testing::TestWithParam<std::tuple<double, bool, Setting>> {};
INSTANTIATE_TEST_SUITE_P(At, SpinningLimb,
                         testing::Combine(testing::Values(100.0, 300.0), testing::Bool(), testing::ValuesIn(kSettings)));

TEST_P(SpinningLimb, KeepsEnergyAndMomentum) {
  const auto [rate, jointed, setting] = GetParam();
  const Outcome it = run("spinning_limb", setting, {}, [rate = rate, jointed = jointed](engine::Model& model) {
    engine::Body& limb = model.bodies[0];
    limb.V_WB.w = {0.01 * rate, rate, 0.01 * rate};  // inertias fall from x to z: y is the middle one
    if (!jointed) return;
    engine::Joint shoulder;
    shoulder.child = 0;
    shoulder.X_CF.p = {0, 0, 0.13};
    shoulder.X_PF.p = limb.X_WB * shoulder.X_CF.p;
    limb.V_WB.v = -limb.V_WB.w.cross(shoulder.X_CF.p);
    model.joints.push_back(shoulder);
  });
  const engine::Body& limb = it.model.bodies[0];
  const Vec3 about = jointed ? it.model.joints[0].X_PF.p : Vec3::Zero();
  auto momentum = [&](const engine::BodyState& s) -> Vec3 {
    const Vec3 spin = s.X_WB.q * (limb.inertia_B * (s.X_WB.q.conjugate() * s.V_WB.w));
    return jointed ? Vec3(spin + limb.mass * (s.X_WB.p - about).cross(s.V_WB.v)) : spin;
  };
  const Vec3 L = momentum(it.recording.snapshots.front().bodies[0]);
  double dE = 0, dL = 0;
  const double E0 = energy(it.recording.snapshots.front());
  for (const engine::Snapshot& s : it.recording.snapshots) {
    dE = std::max(dE, std::abs(energy(s) / E0 - 1));
    dL = std::max(dL, (momentum(s.bodies[0]) - L).norm() / L.norm());
  }
  row("spinning limb", it, "%.0f rad/s %s: energy %.1e, momentum %.1e, %ld steps divided", rate, jointed ? "on its joint" : "free",
      dE, dL, it.diagnostics().substeps);
  const double allowed = rate > 100 ? 1e-5 : 1e-6;
  EXPECT_LT(dE, allowed);
  EXPECT_LT(dL, allowed);
  if (rate * it.model.settings.step > 0.29) {
    EXPECT_GT(it.diagnostics().substeps, 0);
  }
}

}  // namespace
}  // namespace hard_cases
