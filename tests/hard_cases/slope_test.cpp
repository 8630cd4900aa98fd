// A block on a slope a thousandth less steep than its friction, and a thousandth steeper.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

constexpr double kMu = 0.6;

class Slope : public testing::TestWithParam<std::tuple<double, Setting>> {};
INSTANTIATE_TEST_SUITE_P(Over, Slope, testing::Combine(testing::Values(0.999, 1.001, 1.05), testing::ValuesIn(kSettings)));

TEST_P(Slope, HoldsBelowTheFrictionAngleAndSlidesAbove) {
  const auto [share, setting] = GetParam();
  const double angle = std::atan(kMu * share);
  char slope[64];
  std::snprintf(slope, sizeof slope, "simulation.slope=%.17g rad", angle);
  const Outcome it = run("slope", setting, {slope});
  // set down, the block finds its seat: its corners stand some micrometres above its lowest point
  const double moved = it.last(0).X_WB.p.x() - it.recording.at(1).bodies[0].X_WB.p.x();
  if (share < 1) {
    row("slope", it, "tan a = %.3f mu: creeps %.1e m in 9 s", share, moved);
    EXPECT_LT(std::abs(moved), 1e-6);
    return;
  }
  const double a = engine::kGravity * (std::sin(angle) - kMu * std::cos(angle));
  const double got = (it.last(0).V_WB.v.x() - it.recording.at(1).bodies[0].V_WB.v.x()) / 9;
  row("slope", it, "tan a = %.3f mu: slides at %+.3f %% of g (sin a - mu cos a)", share, 100 * (got / a - 1));
  EXPECT_NEAR(got, a, 0.01 * a);
}

}  // namespace
}  // namespace hard_cases
