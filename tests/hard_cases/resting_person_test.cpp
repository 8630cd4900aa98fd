// The whole person lying for a minute, as people lie at the end of every case.
#include <gtest/gtest.h>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

class RestingPerson : public testing::TestWithParam<std::tuple<const char*, const char*>> {};
INSTANTIATE_TEST_SUITE_P(In, RestingPerson,
                         testing::Combine(testing::Values("lying_supine", "lying_prone", "cat"),
                                          testing::Values("stepping", "rk4")));

constexpr double kSettle = kSanitized ? 4 : 15;  // [s] until damped joints have come to where their friction holds them
constexpr double kRest = kSanitized ? 1 : 60;    // [s]

Outcome lie(const char* pose, const char* scheme, const char* sleep) {
  return run("resting_person", {"1 ms", scheme},
             {std::string("person.person.pose=") + pose, "simulation.duration=" + std::to_string(kSettle + kRest) + " s",
              std::string("simulation.sleep=") + sleep});
}

TEST_P(RestingPerson, LiesStill) {
  const auto [pose, scheme] = GetParam();
  const Outcome it = lie(pose, scheme, "false");
  const engine::Snapshot settled = it.recording.at(kSettle), last = it.recording.snapshots.back();
  double creep = 0;
  for (std::size_t b = 0; b < it.model.bodies.size(); ++b)
    creep = std::max(creep, (last.bodies[b].X_WB.p - settled.bodies[b].X_WB.p).norm());
  const double gain = (energy(last) - energy(settled)) / kRest;
  const auto& d = it.diagnostics();
  row("resting person", it, "%s: energy without joint springs %+.1e J/s, creep %.1e m, drift %.1e m, kinetic energy at the end %.1e J",
      pose, gain, creep, d.max_joint_gap, last.energies.kinetic);
  EXPECT_LT(gain, 1e-6);
  EXPECT_LT(creep, 5e-4);
  EXPECT_LT(d.max_joint_gap, 1e-6);
  EXPECT_LT(last.energies.kinetic, 1e-9);
}

}  // namespace
}  // namespace hard_cases
