// The whole person lying for a minute, as people lie at the end of every case.
#include <gtest/gtest.h>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

struct Lying {
  const char *pose, *scheme;
};
void PrintTo(const Lying& lying, std::ostream* out) {
  *out << lying.pose << ' ' << lying.scheme;
}

class RestingPerson : public testing::TestWithParam<Lying> {};
// every joint has dry friction, which makes the schemes the same: once is enough to see that
INSTANTIATE_TEST_SUITE_P(In, RestingPerson,
                         testing::Values(Lying{"lying_supine", "stepping"}, Lying{"lying_prone", "stepping"},
                                         Lying{"cat", "stepping"}, Lying{"lying_supine", "rk4"}));

constexpr double kSettle = kSanitized ? 4 : 15;  // [s] until damped joints have come to where their friction holds them
constexpr double kRest = kSanitized ? 1 : 60;    // [s]

Outcome lie(const Lying& lying, const char* sleep) {
  return run("resting_person", {"1 ms", lying.scheme},
             {std::string("person.person.pose=") + lying.pose, "simulation.duration='" + std::to_string(kSettle + kRest) + " s'",
              std::string("simulation.sleep=") + sleep});
}

double apart(const engine::Snapshot& a, const engine::Snapshot& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.bodies.size(); ++i) most = std::max(most, (a.bodies[i].X_WB.p - b.bodies[i].X_WB.p).norm());
  return most;
}

TEST_P(RestingPerson, LiesStillAwakeAndAsleep) {
  const Outcome it = lie(GetParam(), "false");
  const engine::Snapshot settled = it.recording.at(kSettle), last = it.recording.snapshots.back();
  const double creep = apart(last, settled);
  // springs of joints are not in it: what a leg's passive torques lift counts as a gain
  const double gain = (energy(last) - energy(settled)) / kRest;
  const Outcome sleeper = lie(GetParam(), "true");
  const double aside = apart(sleeper.recording.snapshots.back(), last);
  row("resting person", it, "%s: energy %+.1e J/s, creep %.1e m, drift %.1e m; asleep %.1e m aside, %.0f times as fast",
      GetParam().pose, gain, creep, it.diagnostics().max_joint_gap, aside, it.wall_s / sleeper.wall_s);
  EXPECT_LT(it.diagnostics().max_joint_gap, 1e-6);
  EXPECT_LT(last.energies.kinetic, kSanitized ? 1e-3 : 1e-9);
  if (kSanitized) return;  // too short to have settled
  EXPECT_LT(gain, 1e-6);
  EXPECT_LT(creep, 5e-4);
  EXPECT_LT(aside, 5e-4);
  EXPECT_EQ(sleeper.recording.snapshots.back().energies.kinetic, 0);
}

}  // namespace
}  // namespace hard_cases
