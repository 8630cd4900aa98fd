// The whole person lying for a minute, as people lie at the end of every case.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

struct Lying {
  const char *pose, *step, *scheme;
  double rest = 20;  // [s] after it has settled
};
void PrintTo(const Lying& lying, std::ostream* out) {
  *out << lying.pose << ' ' << lying.step << ' ' << lying.scheme;
}

class RestingPerson : public testing::TestWithParam<Lying> {};
// every joint has dry friction, which makes the schemes the same: once is enough to see that
INSTANTIATE_TEST_SUITE_P(In, RestingPerson,
                         testing::Values(Lying{"lying_supine", "1 ms", "stepping", 60},
                                         Lying{"lying_prone", "1 ms", "stepping", 60}, Lying{"cat", "1 ms", "stepping", 60},
                                         Lying{"lying_supine", "1 ms", "rk4"}, Lying{"lying_supine", "2 ms", "stepping"},
                                         Lying{"lying_prone", "2 ms", "stepping"}, Lying{"cat", "2 ms", "stepping"},
                                         Lying{"lying_supine", "0.5 ms", "stepping"}));

constexpr double kSettle = 15;  // [s] until damped joints have come to where their friction holds them

Outcome lie(const Lying& lying, const char* sleep) {
  return run("resting_person", {lying.step, lying.scheme},
             {std::string("person.person.pose=") + lying.pose,
              "simulation.duration='" + std::to_string(kSettle + lying.rest) + " s'", std::string("simulation.sleep=") + sleep});
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
  // what the springs of joints (a leg's passive torques) give while they creep is booked as negative loss of the joints
  const auto& names = it.recording.effect_names;
  const auto joints = std::find(names.begin(), names.end(), "joint_resistance") - names.begin();
  const double given = settled.energies.dissipated[joints] - last.energies.dissipated[joints];
  const double gain = (energy(last) - energy(settled) - std::max(0.0, given)) / GetParam().rest;
  const Outcome sleeper = lie(GetParam(), "true");
  const double aside = apart(sleeper.recording.snapshots.back(), last);
  row("resting person", it, "%s: energy %+.1e J/s, creep %.1e m, drift %.1e m; asleep %.1e m aside, %.0f times as fast",
      GetParam().pose, gain, creep, it.diagnostics().max_joint_gap, aside, it.wall_s / sleeper.wall_s);
  EXPECT_LT(it.diagnostics().max_joint_gap, 1e-6);
  EXPECT_LT(last.energies.kinetic, 1e-9);
  EXPECT_LT(gain, 1e-6);
  EXPECT_LT(creep, 5e-4 * GetParam().rest / 60);
  EXPECT_LT(aside, 5e-4);
  EXPECT_EQ(sleeper.recording.snapshots.back().energies.kinetic, 0);
}

}  // namespace
}  // namespace hard_cases
