// The whole person lying for a minute, as people lie at the end of every case.
#include <gtest/gtest.h>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

class RestingPerson : public testing::TestWithParam<std::tuple<const char*, const char*>> {};
INSTANTIATE_TEST_SUITE_P(In, RestingPerson,
                         testing::Combine(testing::Values("lying_supine", "lying_prone", "cat"),
                                          testing::Values("stepping", "rk4")));

/// What holds: joints stay closed, nothing hums. Dry friction of the joints gives way in proportion below 0.05 rad/s, so limbs go
/// on sinking by millimetres to centimetres a minute until their joints are slack.
TEST_P(RestingPerson, SinksSlowlyAndHoldsTogether) {
  const auto [pose, scheme] = GetParam();
  const std::string duration = kSanitized ? "5 s" : "60 s";
  const Outcome it =
      run("resting_person", {"1 ms", scheme}, {std::string("person.person.pose=") + pose, "simulation.duration=" + duration});
  const double from = 2;
  const engine::Snapshot settled = it.recording.at(from);
  double creep = 0;
  for (std::size_t b = 0; b < it.model.bodies.size(); ++b)
    creep = std::max(creep, (it.recording.snapshots.back().bodies[b].X_WB.p - settled.bodies[b].X_WB.p).norm());
  const double gain = (energy(it.recording.snapshots.back()) - energy(settled)) / (it.recording.end_time() - from);
  const double kinetic = it.recording.snapshots.back().energies.kinetic;
  const auto& d = it.diagnostics();
  row("resting person", it,
      "%s: energy without joint springs %+.1e J/s, creep %.1e m, drift %.1e m, kinetic energy at the end %.1e J", pose, gain, creep,
      d.max_joint_gap, kinetic);
  EXPECT_LT(kinetic, 1e-3);
  EXPECT_LT(creep, 0.1);
  EXPECT_LT(d.max_joint_gap, 1e-6);
}

}  // namespace
}  // namespace hard_cases
