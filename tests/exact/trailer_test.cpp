// Cars with trailers: loads of the couplings, standing still, backing up and braking.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/simulate.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_file.h"

namespace {

/// A sedan with one trailer, the sedan doing what `acts` says.
std::string with_trailer(bool steered, const std::string& sedan, const std::string& acts) {
  std::string out =
      "[simulation]\nduration = \"4 s\"\nstop_at_rest = false\n[air]\ndensity = 0\n[[vehicle]]\nname = \"sedan\"\nmodel = "
      "\"sedan\"\n" +
      sedan + "\n" + acts;
  if (steered)
    out +=
        "\n[[vehicle]]\nname = \"dolly\"\nmodel = \"dolly\"\ntowed_by = \"sedan\"\n"
        "[[vehicle]]\nname = \"trailer\"\nmodel = \"drawbar_trailer\"\ntowed_by = \"dolly\"\n";
  else
    out += "\n[[vehicle]]\nname = \"trailer\"\nmodel = \"car_trailer\"\ntowed_by = \"sedan\"\n";
  return out;
}

engine::Recording run_of(const std::string& text) {
  const scenes::testing::SceneFolder folder;
  return engine::simulate(folder.load(text).model);
}

double heading(const engine::Snapshot& s, std::size_t body) {
  const engine::Vec3 x = s.bodies[body].X_WB.q * engine::Vec3::UnitX();
  return std::atan2(x.y(), x.x());
}

class Trailer : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Trailer, testing::Values(false, true),
                         [](const auto& p) { return p.param ? "steered" : "single_axle"; });

TEST(SingleAxleTrailer, RestsItsBallLoadOnTheHitch) {
  const engine::Recording run = run_of(with_trailer(false, "", ""));
  const auto& s = run.snapshots.back();
  // moments about the axle: 750 kg 0.26 m in front of it, ball 2.6 m in front. Settled springs tilt it by less than 0.1 degrees
  const double ball = 750 * 9.81 * 0.26 / 2.6;
  EXPECT_NEAR(s.wheels[4].load + s.wheels[5].load, 750 * 9.81 - ball, 0.01 * 750 * 9.81);
  double sedan = 0;
  for (std::size_t w = 0; w < 4; ++w) sedan += s.wheels[w].load;
  EXPECT_NEAR(sedan, 1500 * 9.81 + ball, 0.005 * 1500 * 9.81);
}

TEST_P(Trailer, StandsStillInStaticBalanceFromTheStart) {
  const engine::Recording run = run_of(with_trailer(GetParam(), "", ""));
  for (std::size_t b = 0; b < run.body_names.size(); ++b)
    EXPECT_LT((run.snapshots.back().bodies[b].X_WB.p - run.snapshots.front().bodies[b].X_WB.p).norm(), 1e-3) << run.body_names[b];
}

TEST_P(Trailer, BrakesStably) {
  const engine::Recording run =
      run_of(with_trailer(GetParam(), "speed = \"60 km/h\"", "[[vehicle.driver]]\nfrom = \"0.3 s\"\nlevel = \"0.6 g\"\n"));
  ASSERT_FALSE(run.failure);
  // the trailer pushes, unbraked, and nothing turns it
  for (const auto& s : run.snapshots)
    for (std::size_t b = 0; b < s.bodies.size(); ++b) ASSERT_LT(std::abs(heading(s, b)), 0.5 * std::numbers::pi / 180) << s.time;
  const double mass = GetParam() ? 3300 : 2250;
  const double lost = 0.6 * 9.81 * 1500 / mass * (4 - 0.3 - 0.1);
  EXPECT_NEAR(run.snapshots.back().bodies[0].V_WB.v.x(), std::max(0.0, 60 / 3.6 - lost), 0.1);
  EXPECT_LT(run.diagnostics.max_joint_gap, 1e-6);
}

TEST_P(Trailer, BacksUpStraight) {
  const engine::Recording run =
      run_of(with_trailer(GetParam(), "", "[[vehicle.driver]]\naction = \"accelerate\"\nlevel = \"-0.05 g\"\n"));
  ASSERT_FALSE(run.failure);
  const auto& s = run.snapshots.back();
  EXPECT_LT(s.bodies[0].X_WB.p.x(), -1.0);
  for (std::size_t b = 0; b < s.bodies.size(); ++b) EXPECT_LT(std::abs(heading(s, b)), 1 * std::numbers::pi / 180);
  EXPECT_LT(run.diagnostics.max_joint_gap, 1e-6);
}

/// Backing up with the wheels turned, the trailer folds against the car: they meet before they have folded flat.
TEST(SingleAxleTrailer, IsStruckByTheVehicleThatTowsIt) {
  const engine::Recording run =
      run_of(with_trailer(false, "steer = \"10 deg\"", "[[vehicle.driver]]\naction = \"accelerate\"\nlevel = \"-0.25 g\"\n"));
  ASSERT_FALSE(run.failure);
  double widest = 0, pushed = 0;
  for (const auto& s : run.snapshots) {
    widest = std::max(widest, std::abs(std::remainder(heading(s, 0) - heading(s, 1), 2 * std::numbers::pi)));
    for (const engine::ContactRecord& c : s.contacts)
      if (std::minmax(c.body_a, c.body_b) == std::minmax(0, 1)) pushed += c.normal_impulse;
  }
  EXPECT_GT(widest, 45 * std::numbers::pi / 180);
  EXPECT_LT(widest, 110 * std::numbers::pi / 180);
  EXPECT_GT(pushed, 100);
}

TEST_P(Trailer, RunsInsideTheCurveOfTheCar) {
  const engine::Recording run =
      run_of(with_trailer(GetParam(), "speed = \"9 km/h\"\nsteer = [[\"0 s\", \"0 deg\"], [\"1 s\", \"15 deg\"]]", ""));
  ASSERT_FALSE(run.failure);
  const auto& s = run.snapshots.back();
  const std::size_t last = s.bodies.size() - 1;
  EXPECT_GT(heading(s, 0), heading(s, last));  // it lags
  EXPECT_GT(heading(s, last), 0.02);           // and follows
  EXPECT_LT(run.diagnostics.max_joint_gap, 1e-6);
}

}  // namespace
