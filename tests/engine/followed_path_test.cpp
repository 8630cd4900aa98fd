// Drivers who steer along a line on the ground.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "tests/engine/reference_car.h"

namespace engine::test {
namespace {

TEST(FollowedPath, ThatIsLeftIsTold) {
  Model model = on_ground(4);
  add_reference_car(model, 0, 30);
  // a bend of 30 m radius at 30 m/s asks for three times gravity
  model.vehicles[0].path.points = {{0, 0, 0}, {40, 0, 0}, {62, 9, 0}, {70, 30, 0}, {70, 100, 0}};
  const auto told = [&] {
    const std::vector<std::string> warnings = simulate(model).diagnostics.warnings;
    return std::any_of(warnings.begin(), warnings.end(),
                       [](const std::string& w) { return w.find("car0 leaves its path by up to") != std::string::npos; });
  };
  EXPECT_TRUE(told());
  model.bodies[0].V_WB.v.x() = 8;
  EXPECT_FALSE(told());
}

TEST(FollowedPath, IsHeldAtMotorwaySpeedWithoutWeaving) {
  for (const double kmh : {90.0, 130.0}) {
    Model model = on_ground(12);
    add_reference_car(model, 0, kmh / 3.6);
    // another lane in 150 m
    model.vehicles[0].path.points = {{0, 0, 0}, {20, 0, 0}, {170, 3.5, 0}, {600, 3.5, 0}};
    double beyond = 0, off = 0;  // [m]; a car in a lane of 3.5 m has 0.85 m on either side
    for (const Snapshot& s : simulate(model).snapshots) {
      const Vec3& at = s.bodies[0].X_WB.p;
      beyond = std::max(beyond, at.y() - 3.5);
      if (s.time > 9) off = std::max(off, std::abs(at.y() - 3.5));
    }
    EXPECT_LT(beyond, 0.5) << kmh;  // of a bend without a transition
    EXPECT_LT(off, 0.3) << kmh;
  }
}

TEST(Path, IsFollowedRoundABend) {
  Model model = on_ground(8);
  add_reference_car(model, 0, 10);
  model.vehicles[0].path.points = {{-10, 0, 0}, {30, 0, 0}, {50, 10, 0}, {100, 35, 0}};
  const Recording run = simulate(model);
  // pure pursuit cuts the corner by half its preview; on the last leg it is back on the line
  const Snapshot s = run.snapshots.back();
  const Vec3 on = Vec3(50, 10, 0), along = Vec3(2, 1, 0).normalized();
  const Vec3 off = s.bodies[0].X_WB.p - on;
  EXPECT_GT(off.dot(along), 15);
  EXPECT_LT(std::abs(Vec3(0, 0, 1).dot(along.cross(Vec3(off.x(), off.y(), 0)))), 0.3);
}

/// A ring of 72 legs round (0, radius), driven counter-clockwise or clockwise from the origin on.
std::vector<Vec3> ring(double radius, double turn) {
  std::vector<Vec3> out;
  for (int i = 0; i <= 72; ++i) {
    const double angle = i * std::numbers::pi / 36;
    out.emplace_back(radius * std::sin(angle), turn * radius * (1 - std::cos(angle)), 0);
  }
  return out;
}

TEST(Path, IsALapAndDrivenRoundFromItsStart) {
  constexpr double kRadius = 40;  // [m]
  // a car that looks beyond the first leg from the start on, and a slow one whose front stands there
  for (const auto& [speed, behind] : {std::pair(12.0, 0.0), std::pair(3.0, 2.0)}) {  // [m/s], [m]
    Model model = on_ground(15);
    add_reference_car(model, -behind, speed);
    model.vehicles[0].path.points = ring(kRadius, 1);
    const Recording run = simulate(model);
    for (const Snapshot& s : run.snapshots) {
      const double r = (s.bodies[0].X_WB.p - Vec3(0, kRadius, 0)).head<2>().norm();
      ASSERT_NEAR(r, kRadius, 1) << speed << " m/s, " << s.time << " s: half of the lane beside a car, which is not left";
    }
    EXPECT_THAT(run.diagnostics.warnings, testing::IsEmpty());
  }
}

TEST(Path, ThatCrossesItselfIsDrivenToItsEnd) {
  // a figure of eight, then straight on through where it began
  constexpr double kRadius = 20, kSpeed = 8;  // [m], [m/s]
  Model model = on_ground(2 * 2 * std::numbers::pi * kRadius / kSpeed);
  add_reference_car(model, 0, kSpeed);
  std::vector<Vec3> path = ring(kRadius, 1);
  const std::vector<Vec3> second = ring(kRadius, -1);
  path.insert(path.end(), second.begin() + 1, second.end());
  path.emplace_back(100, 0, 0);
  model.vehicles[0].path.points = path;
  double least = 0, most = 0;  // [m]
  const Recording run = simulate(model);
  for (const Snapshot& s : run.snapshots) {
    least = std::min(least, s.bodies[0].X_WB.p.y());
    most = std::max(most, s.bodies[0].X_WB.p.y());
  }
  EXPECT_NEAR(most, 2 * kRadius, 1);
  EXPECT_NEAR(least, -2 * kRadius, 1);
}

}  // namespace
}  // namespace engine::test
