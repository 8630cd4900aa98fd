// What is slow and about to go has not come to rest: the run goes on, and tells no rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/engine/reference_car.h"

namespace engine::test {
namespace {

bool rests(const Recording& run) {
  return std::any_of(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "rest"; });
}

/// The reference car, unbraked, on a road that rises along x by so much.
Model on_slope(double angle, double speed, double duration) {
  Model model = on_ground(duration);
  model.settings.stop_at_rest = true;
  model.settings.gravity = kGravity * Vec3(-std::sin(angle), 0, -std::cos(angle));
  add_reference_car(model, 0, speed);
  return model;
}

/// Wheels have no inertia of their own and nothing resists: x = v t - g sin(angle) t^2 / 2.
TEST(Rest, IsNotWhatRollsAwayFromAStand) {
  constexpr double kTime = 4;
  for (const double angle : {0.003, 0.01, 0.03}) {
    const Recording run = simulate(on_slope(angle, 0, kTime));
    EXPECT_NEAR(run.end_time(), kTime, 1e-9) << angle;
    EXPECT_FALSE(rests(run)) << angle;
    const double way = 0.5 * kGravity * std::sin(angle) * kTime * kTime;
    EXPECT_NEAR(run.snapshots.back().bodies[0].X_WB.p.x(), -way, 0.01 * way + 2e-3) << angle << ": its springs settle";
  }
}

TEST(Rest, IsNotTheTopOfAWay) {
  for (const double angle : {0.005, 0.02}) {
    const double up = 1, top = up / (kGravity * std::sin(angle)), duration = 2.2 * top;
    const Recording run = simulate(on_slope(angle, up, duration));
    EXPECT_NEAR(run.end_time(), duration, 2e-3) << angle;
    EXPECT_FALSE(rests(run)) << angle;
    EXPECT_LT(run.snapshots.back().bodies[0].V_WB.v.x(), -up) << "past where it came from";
  }
}

TEST(Rest, IsNotASlowCoast) {
  const Recording run = simulate(on_slope(0, 0.04, 3));
  EXPECT_NEAR(run.snapshots.back().bodies[0].X_WB.p.x(), 0.12, 2e-3);
  EXPECT_FALSE(rests(run));
}

TEST(Rest, IsNotASmallDriveThatHasJustBegun) {
  Model model = on_slope(0, 0, 4);
  model.vehicles[0].drive_force = 100.0;  // [N]: 0.067 m/s^2
  const Recording run = simulate(model);
  EXPECT_NEAR(run.snapshots.back().bodies[0].V_WB.v.x(), 4 * 100 / model.bodies[0].mass, 0.01);
}

/// 17 degrees where friction holds 16.7.
TEST(Rest, IsNotABlockAboveTheAngleOfFriction) {
  const double mu = 0.3, angle = 17 * kDegree, duration = 5;
  Model model = on_slope(angle, 0, duration);
  model.vehicles.clear();
  model.bodies = {solid({{0.3, 0.3, 0.1}, 8}, 20, {0, 0, 0.1})};
  model.bodies[0].surface.friction_ground = mu;
  const Recording run = simulate(model);
  const double acceleration = kGravity * (std::sin(angle) - mu * std::cos(angle));
  EXPECT_NEAR(run.snapshots.back().bodies[0].V_WB.v.x(), -acceleration * duration, 0.02 * acceleration * duration);
  EXPECT_FALSE(rests(run));
}

/// The other side: what is held stays, and ends the run.
TEST(Rest, IsWhatABrakeHoldsOnASlope) {
  Model model = on_slope(0.1, 0, 4);
  model.vehicles[0].brake = 5000.0;
  const Recording run = simulate(model);
  EXPECT_LT(run.end_time(), 2) << "once its springs have settled";
  EXPECT_TRUE(rests(run));
}

}  // namespace
}  // namespace engine::test
