// Vehicles off their wheels: bodywork on ground, kerb and terrain by Default-Auto.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "engine/measure/metrics.h"
#include "engine/record/rest_watch.h"
#include "engine/simulate.h"
#include "scenes/scene.h"

namespace {

const std::string kCasesFolder = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/";

double mechanical(const engine::Snapshot& s) {
  return s.energies.kinetic + s.energies.potential;
}

engine::Vec3 up_of(const engine::Snapshot& s, int body) {
  return s.bodies[static_cast<std::size_t>(body)].X_WB.q * engine::Vec3::UnitZ();
}

/// A car comes down on its wheels and its steps are cut: springs are booked in the step that pressed them. Booked in the next one,
/// which may be half as long, the dampers seem to give 105 J. What remains is friction of the step in which the kerb strikes: it
/// stands against the slide that is left, which the strike turned round.
TEST(Rollover, BooksSpringsInTheStepThatPressesThem) {
  const engine::Recording run = engine::simulate(scenes::load(kCasesFolder + "rollover.toml").model);
  EXPECT_GT(run.diagnostics.substeps, 0) << "steps of several lengths";
  EXPECT_LT(run.diagnostics.max_effect_gain, 15);
}

/// A wheel that lands leaning goes over onto its flank under 15 tonnes. A strut that stayed where the step began gave 250 J.
TEST(Rollover, MovesTheStrutToTheEndOfTheStepInWhichItsWheelLeavesTheTread) {
  engine::Model model = scenes::load(std::string(CRASHREEL_SOURCE_DIR) + "/scenes/gallery/rollover_bank.toml").model;
  model.settings.duration = 1.2;
  // what remains is of first order in the step: a spring of 30 kN/m beyond its stop that closes at 10 m/s
  EXPECT_LT(engine::simulate(model).diagnostics.max_effect_gain, 20);
}

TEST(Rollover, OfASedanTrippedAtSixtyRunsToRestWithoutGainingEnergy) {
  const scenes::Scene scene = scenes::load(kCasesFolder + "rollover.toml");
  ASSERT_EQ(scene.model.settings.step, 1e-3);
  const engine::Recording run = engine::simulate(scene.model);
  ASSERT_FALSE(run.failure);
  // it turned over: its roof pointed down once
  EXPECT_TRUE(std::any_of(run.snapshots.begin(), run.snapshots.end(), [](const auto& s) { return up_of(s, 0).z() < -0.5; }));
  EXPECT_LT(run.end_time(), scene.model.settings.duration - 1) << "has come to rest";
  EXPECT_LT(run.snapshots.back().bodies[0].V_WB.v.norm(), 0.05);
  EXPECT_LT(run.diagnostics.rest_penetration, 1e-5);
  // nor do wheels that come down onto their flank pressed in: 4.8 mm where they were as hard there as the body
  EXPECT_LT(run.diagnostics.max_penetration, 1e-3);
  const double initial = mechanical(run.snapshots.front());
  double lowest = initial, rise = 0, unexplained = 0;
  for (const auto& s : run.snapshots) {
    rise = std::max(rise, mechanical(s) - lowest);
    lowest = std::min(lowest, mechanical(s));
    unexplained = std::max(unexplained, std::abs(s.energies.residual));
  }
  // springs are taken at the compression of the step's start: a part of a step of what they store
  EXPECT_LT(rise, 1e-3 * initial);
  EXPECT_LT(unexplained, 2e-3 * initial);
}

/// What is quoted of it against the trajectory: the roll speed about its long axis adds up to the turns.
TEST(Rollover, IsMeasuredAsTheTrajectoryShowsIt) {
  const scenes::Scene scene = scenes::load(kCasesFolder + "rollover.toml");
  const engine::Recording run = engine::simulate(scene.model);
  const auto value = [metrics = engine::measure(scene.model, run)](const std::string& key) {
    const auto at = std::find_if(metrics.begin(), metrics.end(), [&](const engine::Metric& m) { return m.key == key; });
    return at == metrics.end() ? std::nan("") : at->value;
  };
  double rolled = 0;  // [rad]
  for (const engine::Snapshot& s : run.snapshots) {
    const auto& [X, V] = s.bodies[0];
    rolled += run.interval * (X.q.conjugate() * V.w).x();
  }
  // what yaw and pitch add to it while the car leans is less than half a quarter
  EXPECT_EQ(value("quarter_turns"), std::round(std::abs(rolled) / (std::numbers::pi / 2)));
  EXPECT_GE(value("quarter_turns"), 2) << "its roof pointed down";
  // the kerb's near edge is reached by the wheels of one side; until then it slides on all four
  const engine::Snapshot trip = run.at(value("trip_s")), rest = run.at(value("rest_s"));
  EXPECT_GT(value("trip_s"), 0);
  EXPECT_LT(std::acos(up_of(trip, 0).z()), 0.35) << "20 degrees";
  const double straight = (rest.bodies[0].X_WB.p - trip.bodies[0].X_WB.p).head<2>().norm();
  EXPECT_GE(value("roll_distance_m"), straight - 0.02);
  EXPECT_LT(value("roll_distance_m"), 1.3 * straight);
  EXPECT_TRUE(std::isnan(value("roll_drag_factor"))) << "the kerb took most of its speed, which is no drag";
  const std::vector<engine::AbsentMetric> absent = engine::absent_metrics(scene.model, run, engine::measure(scene.model, run));
  EXPECT_TRUE(std::any_of(absent.begin(), absent.end(), [](const auto& a) { return a.key == "roll_drag_factor"; }));
}

/// It falls back on its wheels: rest is the first instant from which it is slow on the road, though it rocks on its springs.
TEST(Rollover, RestIsWhenItIsSlowForGood) {
  const engine::Model model = scenes::load(kCasesFolder + "rollover.toml").model;
  const engine::Recording run = engine::simulate(model);
  const auto rest = std::find_if(run.events.begin(), run.events.end(), [](const engine::Event& e) { return e.kind == "rest"; });
  ASSERT_NE(rest, run.events.end());
  EXPECT_LE(rest->time, run.end_time() - 0.25 + 1e-9) << "as long as a run must see it at rest";
  const auto moves = [&](const engine::Snapshot& s) {
    const engine::Twist V = engine::travel_of(model, 0, s.bodies[0].X_WB, s.bodies[0].V_WB);
    return std::max(V.v.norm() / 0.05, V.w.norm() / 0.3);
  };
  // the middle of its four footprints, which rocking does not move: 0.05 m/s that die down in less than half a second
  const auto stands = [&](const engine::Snapshot& s) {
    engine::Vec3 middle = engine::Vec3::Zero();
    for (const engine::Wheel& wheel : model.vehicles[0].wheels)
      middle += s.bodies[0].X_WB * engine::Vec3(wheel.hub_B - wheel.radius * engine::Vec3::UnitZ()) / 4;
    return middle;
  };
  const engine::Vec3 way = stands(run.snapshots.back()) - stands(run.at(rest->time));
  EXPECT_LT(way.head<2>().norm(), 0.02);
  bool moved = false;  // just before
  for (const engine::Snapshot& s : run.snapshots) {
    if (s.time >= rest->time) {
      EXPECT_LT(moves(s), 1) << s.time;
    } else if (s.time > rest->time - 0.05) {
      moved |= moves(s) >= 1;
    }
  }
  EXPECT_TRUE(moved);
}

/// The sedan dropped on its roof or side.
class Dropped : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Attitudes, Dropped, testing::Values(90.0, 150.0, 180.0, 265.0));

TEST_P(Dropped, ComesToRestOnItsBodywork) {
  const scenes::Scene scene =
      scenes::load(kCasesFolder + "rollover.toml",
                   {"vehicle.sedan.velocity=\"1 0 0 m/s\"", "vehicle.sedan.position=\"0 -9 m\"", "vehicle.sedan.lift=\"1.9 m\"",
                    "vehicle.sedan.attitude=\"" + std::to_string(GetParam()) + " 3 0 deg\"", "simulation.duration=\"12 s\""});
  const engine::Recording run = engine::simulate(scene.model);
  ASSERT_FALSE(run.failure);
  // on the crown of its roof a rigid car rocks by a degree for long: nothing takes the energy of rolling
  EXPECT_LT(run.snapshots.back().bodies[0].V_WB.v.norm(), 0.3);
  EXPECT_LT(run.diagnostics.rest_penetration, 5e-3);
  // what it lies on carries its weight, in the mean over the last second of rocking
  double carried = 0;
  const std::size_t count = std::min<std::size_t>(run.snapshots.size(), static_cast<std::size_t>(1 / run.interval));
  for (std::size_t i = run.snapshots.size() - count; i < run.snapshots.size(); ++i) {
    for (const auto& c : run.snapshots[i].contacts) carried += c.impulse.z() / run.interval / static_cast<double>(count);
    for (const auto& w : run.snapshots[i].wheels) carried += w.load / static_cast<double>(count);
  }
  EXPECT_NEAR(carried, 1500 * 9.81, 0.05 * 1500 * 9.81);
  const double initial = mechanical(run.snapshots.front());
  EXPECT_LT(run.diagnostics.max_energy_rise, 1e-3 * initial);
}

TEST(Rollover, DownABankOfTrianglesComesToRestOnThem) {
  const scenes::Scene scene = scenes::load(std::string(CRASHREEL_SOURCE_DIR) + "/scenes/gallery/rollover_bank.toml");
  const engine::Recording run = engine::simulate(scene.model);
  ASSERT_FALSE(run.failure);
  EXPECT_TRUE(std::any_of(run.snapshots.begin(), run.snapshots.end(), [](const auto& s) { return up_of(s, 0).z() < -0.2; }))
      << "it rolled over";
  EXPECT_TRUE(std::any_of(run.snapshots.begin(), run.snapshots.end(), [](const auto& s) {
    return std::any_of(s.contacts.begin(), s.contacts.end(),
                       [](const auto& c) { return c.shapes.b == engine::ShapeKind::terrain; });
  }));
  EXPECT_LT(run.snapshots.back().bodies[0].V_WB.v.norm(), 0.05);
  EXPECT_LT(run.diagnostics.rest_penetration, 1e-5);
  EXPECT_LT(run.diagnostics.max_penetration, 1e-3) << "6.8 mm with wheels as hard on their flanks as the body";
  // it comes back onto its wheels, whose struts go on from where they stood on their flanks; set to what the road asks of them at
  // once, they gave 21 J. What remains is a part of a step of what springs take, of 0.5 * 1500 * 11.1^2 = 92 kJ
  EXPECT_LT(run.diagnostics.max_energy_rise, 5);
}

TEST(CarAgainstCar, ByDefaultAutoKeepsMomentumAndDoesNotPassThrough) {
  scenes::Scene scene = scenes::load(kCasesFolder + "intersection_ks.toml", {"vehicle.red.collision=\"default_auto\""});
  scene.model.settings.duration = 1.5;
  const engine::Recording run = engine::simulate(scene.model);
  ASSERT_FALSE(run.failure);
  engine::Vec3 on_red = engine::Vec3::Zero();
  double deepest = 0;
  for (const auto& s : run.snapshots)
    for (const auto& c : s.contacts) {
      if (!c.shapes.between_vehicles()) continue;
      on_red += c.body_a == 0 ? c.impulse : engine::Vec3(-c.impulse);
      deepest = std::max(deepest, c.depth);
    }
  // first touch at full closing speed: red is thrown back, and nothing sinks in by more than a step at 19 m/s
  EXPECT_LT(on_red.x(), -1500 * 3.0);
  EXPECT_LT(deepest, 0.02);
  EXPECT_LT(run.diagnostics.max_energy_rise, 1e-3 * mechanical(run.snapshots.front()));
}

}  // namespace
