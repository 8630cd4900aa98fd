// The whole person lying for a minute, as people lie at the end of every case.
#include <gtest/gtest.h>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

class RestingPerson : public testing::TestWithParam<std::tuple<const char*, bool, Setting>> {};
INSTANTIATE_TEST_SUITE_P(In, RestingPerson,
                         testing::Combine(testing::Values("lying_supine", "lying_prone", "cat"), testing::Bool(),
                                          testing::ValuesIn(kSettings)));

TEST_P(RestingPerson, LiesStill) {
  const auto [pose, sleep, setting] = GetParam();
  const Outcome it = run("resting_person", setting, {std::string("person.person.pose=") + pose},
                         [sleep = sleep](engine::Model& m) { m.settings.sleep = sleep; });
  // what has to settle settles in the first five seconds; then nothing moves for the rest of the minute
  const double from = 5;
  const engine::Snapshot settled = it.recording.at(from);
  double creep = 0;
  for (std::size_t b = 0; b < it.model.bodies.size(); ++b)
    creep = std::max(creep, (it.recording.snapshots.back().bodies[b].X_WB.p - settled.bodies[b].X_WB.p).norm());
  const double gain = (energy(it.recording.snapshots.back()) - energy(settled)) / (it.recording.end_time() - from);
  const auto& d = it.diagnostics();
  row("resting person", it, "%s%s: energy %+.1e J/s, creep %.1e m, drift %.1e m", pose, sleep ? ", sleep" : "", gain, creep,
      d.max_joint_gap);
  EXPECT_LT(gain, 1e-6);
  EXPECT_LT(creep, 5e-4);
  EXPECT_LT(d.max_joint_gap, 1e-6);
  EXPECT_NEAR(it.recording.end_time(), 60, 1e-6);
}

}  // namespace
}  // namespace hard_cases
