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

}  // namespace
}  // namespace hard_cases
