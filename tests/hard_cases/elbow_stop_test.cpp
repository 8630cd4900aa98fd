// A straight arm props the torso up: a limit and the ground carry one load.
#include <gtest/gtest.h>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

class ElbowStop : public testing::TestWithParam<Setting> {};
INSTANTIATE_TEST_SUITE_P(At, ElbowStop, testing::ValuesIn(kSettings));

TEST_P(ElbowStop, CarriesTheTorso) {
  const Outcome it = run("elbow_stop", GetParam(), {}, [](engine::Model& m) { m.settings.record_interval = m.settings.step; });
  // contacts that press, from step to step: their set must not flicker once all stands
  int changes = 0;
  std::vector<int> pressing, before;
  for (const engine::Snapshot& s : it.recording.snapshots) {
    pressing.clear();
    for (const engine::ContactRecord& c : s.contacts)
      if (c.normal_impulse > 0) pressing.push_back(c.body_a);
    changes += pressing != before;
    before = pressing;
  }
  const auto& d = it.diagnostics();
  row("elbow at its stop", it,
      "limit %.3f deg, penetration %.3f mm, residual %.1e m/s, active set changed in %d steps, end height %.3f m",
      degrees(d.max_joint_angle_error), d.max_penetration * 1e3, d.max_solver_residual, changes, it.last(0).X_WB.p.z());
  EXPECT_LT(degrees(d.max_joint_angle_error), 0.5);
  EXPECT_LT(d.max_penetration, 1e-3);
  EXPECT_LT(d.max_solver_residual, 1e-5);
  EXPECT_LE(changes, 20);
}

}  // namespace
}  // namespace hard_cases
