// Tyre laws against their defining points.
#include "engine/laws/tyre.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace engine::test {
namespace {

constexpr double kSaturates = 10 * std::numbers::pi / 180;  // [rad]

TEST(TmEasy, PassesThroughItsDefiningPoints) {
  const TmEasyTyre tyre = passenger_car_tyre(4000);
  const double mu = 1.1;  // the longitudinal maximum over the nominal load: as published
  const TyreForce at_max = tm_easy_force(tyre, 4000, mu, 0.11, 0);
  EXPECT_NEAR(at_max.longitudinal, 4400, 1e-9 * 4400);
  EXPECT_NEAR(at_max.lateral, 0, 1e-9);
  EXPECT_NEAR(tm_easy_force(tyre, 4000, mu, 0, 0.20).lateral, 4200, 1e-9 * 4200);
  EXPECT_NEAR(tm_easy_force(tyre, 8000, mu, 0.10, 0).longitudinal, 8700, 1e-9 * 8700);
  EXPECT_NEAR(tm_easy_force(tyre, 4000, mu, 0, 5).lateral, 4150, 1e-9 * 4150);
  // slope at the origin: the secant of a slip of 1e-6 differs by (dF0 sM/FM - 2) s/sM < 1e-5
  EXPECT_NEAR(tm_easy_force(tyre, 4000, mu, 0, 1e-6).lateral / 1e-6, 55e3, 1e-5 * 55e3);
  EXPECT_NEAR(tm_easy_force(tyre, 4000, mu, 1e-6, 0).longitudinal / 1e-6, 120e3, 1e-5 * 120e3);
}

TEST(TmEasy, IsContinuousInForceAndSlopeAndNeverBeyondItsCircle) {
  const SlipCurve c{55e3, 0.2, 4200, 0.8, 4150};
  for (const double s : {c.slip_max, c.slip_sliding}) {
    constexpr double d = 1e-6;
    EXPECT_NEAR(force_of(c, s - d), force_of(c, s + d), 1e-3);
    const double before = (force_of(c, s) - force_of(c, s - d)) / d, after = (force_of(c, s + d) - force_of(c, s)) / d;
    EXPECT_NEAR(before, after, 2e-5 * c.slope);  // both vanish; second order in d
  }
  const TmEasyTyre tyre = passenger_car_tyre(4000);
  for (double sx = 0; sx < 1.2; sx += 0.07)
    for (double sy = 0; sy < 1.2; sy += 0.07) {
      const TyreForce f = tm_easy_force(tyre, 5000, 0.8, sx, sy);
      EXPECT_LE(std::hypot(f.longitudinal, f.lateral), 0.8 * 5000 * 1.001);
    }
}

TEST(TmEasy, BrakingTakesFromTheLateralForce) {
  const TmEasyTyre tyre = passenger_car_tyre(4000);
  double last = 1e9;
  for (const double asked : {0.0, 1000.0, 2000.0, 3000.0}) {
    const double lateral = tm_easy_grip(tyre, 4000, 1.0, 20, 1, asked).damping;
    EXPECT_LT(lateral, last);
    last = lateral;
  }
}

TEST(LinearTyre, SaturatesAtItsAngle) {
  const double v = 20, angle = kSaturates;
  const Grip grip = linear_grip(4000, 0.8, 0.8, angle, v, v * std::tan(angle));
  EXPECT_NEAR(grip.damping * v * std::tan(angle), 0.8 * 4000, 1e-9 * 3200);
}

TEST(LinearTyre, KeepsItsStiffnessOnIceAndSaturatesAtASmallerAngle) {
  const double v = 20, angle = kSaturates;
  const Grip dry = linear_grip(4000, 0.8, 0.8, angle, v, 0), ice = linear_grip(4000, 0.1, 0.8, angle, v, 0);
  EXPECT_EQ(ice.damping, dry.damping) << "the same force at the same small slip";
  EXPECT_EQ(ice.friction, 0.1);
  // the circle is reached at an eighth of the tangent
  EXPECT_NEAR(ice.damping * v * std::tan(angle) / 8, 0.1 * 4000, 1e-9 * 400);
}

}  // namespace
}  // namespace engine::test
