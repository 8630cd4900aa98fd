// Two library sedans at 60 km/h each, head-on, on ever less of their widths.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/measure/impacts.h"
#include "engine/simulate.h"
#include "tests/scenes/scene_file.h"

namespace hard_cases {
namespace {

constexpr double kWidth = 1.8;      // [m] of the sedan
constexpr double kFull = 60 / 3.6;  // [m/s] each loses when they meet squarely
constexpr double kBefore = 0.015;   // [-] what rolling and air take before the touch
constexpr double kYaw2 = 1.947;     // [m^2] the sedan's 2920 kg m^2 over 1500 kg

/// What a plastic push without friction takes in the middle of the overlap, at a lever h: v k^2 / (k^2 + h^2). Friction holds the
/// fronts on each other and adds to it.
double without_friction(double overlap) {
  const double lever = 0.5 * (kWidth - overlap);
  return kFull * kYaw2 / (kYaw2 + lever * lever);
}

struct Struck {
  double delta_v = 0, yaw_rate = 0;  // of the first [m/s], [rad/s], left positive
};

/// `side`: 1 where left meets left, -1 where right meets right.
Struck head_on(double overlap, int side, const std::string& collision = "") {
  const auto car = [&](const std::string& name, double x, double y, int heading) {
    return "[[vehicle]]\nname = \"" + name + "\"\nmodel = \"sedan\"\nspeed = \"60 km/h\"\nfront = \"" + std::to_string(x) + " " +
           std::to_string(y) + " m\"\nheading = \"" + std::to_string(heading) + " deg\"\n" + collision;
  };
  const scenes::Scene scene = scenes::testing::folder().load("[simulation]\nduration = \"0.4 s\"\n" + car("a", -4, 0, 0) +
                                                             car("b", 4, side * (kWidth - overlap), 180));
  const engine::Recording run = engine::simulate(scene.model);
  const std::vector<engine::Impact> impacts = engine::impacts_of(scene.model, run);
  EXPECT_EQ(impacts.size(), 1u) << overlap;
  return {impacts.at(0).a.delta_v.norm(), impacts.at(0).a.yaw_rate_after};
}

/// Less of the width never gives more. Down to 40 %, where longitudinal members meet in offset tests, a car loses what a push takes
/// that it cannot slide off, and turns towards the side that was struck: by a quarter at least of what such a push without friction
/// gives, h / k^2 times the delta-v. On a twelfth it is a graze.
TEST(OffsetHeadOn, DeltaVFallsWithTheOverlap) {
  double last = kFull;
  for (const double overlap : {1.8, 1.2, 0.92, 0.72, 0.52, 0.42, 0.32, 0.22, 0.15, 0.1}) {
    const double delta_v = head_on(overlap, 1).delta_v;
    EXPECT_LT(delta_v, last) << overlap;
    last = delta_v;
  }
  EXPECT_NEAR(head_on(1.8, 1).delta_v, kFull, kBefore * kFull);
  for (const double overlap : {0.92, 0.72}) EXPECT_GT(head_on(overlap, 1).yaw_rate, 1) << overlap;
  for (const double overlap : {1.2, 0.92, 0.72}) {
    EXPECT_GT(head_on(overlap, 1).delta_v, without_friction(overlap)) << overlap;
    EXPECT_GT(head_on(overlap, 1).yaw_rate, 0.25 * 0.5 * (kWidth - overlap) / kYaw2 * kFull) << overlap;
  }
  EXPECT_LT(head_on(0.15, 1).delta_v, 0.3 * kFull);
}

TEST(OffsetHeadOn, IsTheSameMirrored) {
  for (const double overlap : {0.72, 0.32}) {
    const Struck left = head_on(overlap, 1), right = head_on(overlap, -1);
    EXPECT_NEAR(left.delta_v, right.delta_v, 0.01 * left.delta_v) << overlap;
    EXPECT_NEAR(left.yaw_rate, -right.yaw_rate, 0.02) << overlap;
  }
}

/// A second law agrees where rigid corners do not hook. It pushes along the normals of the faces that touch first, which are those
/// of rounded corners: on 40 % that is 8 % of the speed.
TEST(OffsetHeadOn, IsThatOfDefaultAutoWhereFrontsMeet) {
  for (const double overlap : {1.8, 1.2, 0.92, 0.72})
    EXPECT_NEAR(head_on(overlap, 1).delta_v, head_on(overlap, 1, "collision = \"default_auto\"\n").delta_v, 0.12 * kFull)
        << overlap;
}

}  // namespace
}  // namespace hard_cases
