// What is measured of vehicles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "engine/measure/phases.h"
#include "engine/measure/vehicle_events.h"
#include "tests/engine/hand_made_runs.h"

namespace engine {
namespace {

TEST(VehicleMetrics, DeltaVIsTheChangeOfVelocityOfTheCollisionAndNotOfTheRun) {
  Model model = person_and_car();
  model.settings.gravity.setZero();
  Recording run = standing_still(60);
  // the car heads along +y when it is struck and turns afterwards, which must not matter
  const Vec3 after(-3, -3, 0);
  for (int i = 0; i < 60; ++i) {
    Snapshot& s = run.snapshots[i];
    if (i < 5) s.bodies.own()[kCar].X_WB.q = Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));
    s.bodies.own()[kCar].V_WB.v = i < 5 ? Vec3(0, 20, 0) : Vec3(Vec3(0, 20, 0) + after);
    s.tyre_impulse = {Vec3::Zero()};
  }
  // it brakes with 100 N s meanwhile, which is no collision
  run.snapshots[5].tyre_impulse = {Vec3(0, -100, 0)};
  for (Snapshot& s : run.snapshots)
    if (s.time > 0.045) s.bodies.own()[kCar].V_WB.v.y() -= 0.1;
  run.snapshots[5].contacts = {push(kHips, kCar, kOnVehicle, {3000, 3000, 0}), push(kCar, -1, kOnGround, {0, 0, 1e6})};
  // and drags on for half a second, pressed and held: that adds nothing
  for (int i = 6; i < 60; ++i) run.snapshots[i].contacts = {push(kHips, kCar, kOnVehicle, {2, 0, 0})};
  std::vector<Metric> out;
  measure_vehicle(model, run, impacts_of(model, run), 0, out);
  EXPECT_NEAR(value_of(out, "delta_v_mps").value(), 3 * std::sqrt(2.0), 1e-9);
  // pushed backwards and to the left: from the right front
  EXPECT_NEAR(value_of(out, "pdof_deg").value(), 45, 1e-9);
  EXPECT_FALSE(value_of(out, "ees_mps")) << "a person takes up no energy that would deform a car";
}

TEST(VehicleMetrics, DeltaVIsThatOfTheLargestImpulseWhateverAThirdOneDidMeanwhile) {
  Model model = person_and_car();
  model.settings.gravity.setZero();
  Recording run = standing_still(60);
  const auto speed = [](int i) { return i < 5 ? 10.0 : i < 40 ? 4.0 : -3.0; };
  for (int i = 0; i < 60; ++i) run.snapshots[i].bodies.own()[kCar].V_WB.v = {speed(i), 0, 0};
  run.snapshots[5].contacts = {push(kHips, kCar, kOnVehicle, {6000, 0, 0})};
  // it is pressed down besides, which changes no speed along the road; of the 7 m/s of the second phase 3 are a third one's
  run.snapshots[40].contacts = {push(kHips, kCar, kOnVehicle, {4000, 0, 9000})};
  const std::vector<Impact> impacts = impacts_of(model, run);
  ASSERT_EQ(impacts.size(), 2u);
  const ImpactSide& car = impacts[1].a.party.vehicle == 0 ? impacts[1].a : impacts[1].b;
  EXPECT_NEAR(car.delta_v.norm(), 7, 1e-9);
  EXPECT_EQ(hardest_impact(model, impacts, 0), &impacts[0]);
  EXPECT_EQ(hardest_impact(model, impacts, 1), nullptr);
  std::vector<Metric> out;
  measure_vehicle(model, run, impacts, 0, out);
  EXPECT_NEAR(value_of(out, "delta_v_mps").value(), 6, 1e-9);
}

/// The person is hips alone; what else is the head is a block here. Without gravity, so that speeds are of pushes only.
Model car_person_and_block() {
  Model model = person_and_car();
  model.settings.gravity.setZero();
  model.bodies[kHead].person = -1;
  model.persons[0].bodies = {kHips};
  return model;
}

/// A car of 1000 kg strikes a person from 0.05 s and 20 ms later a block, both for some time: it is as if one had struck it. A push
/// long after them is another event.
TEST(VehicleMetrics, PhasesThatOverlapAreOneEventWhoeverStruck) {
  const Model model = car_person_and_block();
  Recording run = standing_still(60);
  double speed = 10;
  for (int i = 0; i < 60; ++i) {
    const bool person = i >= 5 && i < 15, block = i >= 7 && i < 10;
    speed -= (person ? 0.1 : 0) + (block ? 0.5 : 0) - (i == 50 ? 1 : 0);
    run.snapshots[i].bodies.own()[kCar].V_WB.v = {speed, 0, 0};
    if (person) run.snapshots[i].contacts.push_back(push(kHips, kCar, kOnVehicle, {100, 0, 0}));
    if (block) run.snapshots[i].contacts.push_back(push(kHead, kCar, kOnVehicle, {500, 0, 0}));
  }
  run.snapshots[50].contacts.push_back(push(kHips, kCar, kOnVehicle, {-1000, 0, 0}));
  const std::vector<Impact> impacts = impacts_of(model, run);
  ASSERT_EQ(impacts.size(), 3u);
  const auto car = [](const Impact& i) { return i.a.party.vehicle == 0 ? i.a : i.b; };
  EXPECT_NEAR(car(impacts[0]).own_delta_v.norm(), 1.0, kAlmost);
  EXPECT_NEAR(car(impacts[1]).own_delta_v.norm(), 1.5, kAlmost);
  const ImpactSide event = hardest_event(model, run, impacts, 0).value();
  EXPECT_EQ(event.phases, 2);
  EXPECT_NEAR(event.delta_v.norm(), 2.5, 1e-9);
  std::vector<Metric> out;
  measure_vehicle(model, run, impacts, 0, out);
  EXPECT_NEAR(value_of(out, "delta_v_mps").value(), 2.5, 1e-9);
}

/// Struck from behind and at once from ahead, it has the larger of the two changes and not what they leave.
TEST(VehicleMetrics, BlowsFromBothSidesDoNotCancel) {
  Model model = person_and_car();
  model.bodies[kHips].person = -1;
  Recording run = standing_still(60);
  for (int i = 0; i < 60; ++i) run.snapshots[i].bodies.own()[kCar].V_WB.v = {i < 10 ? 0.0 : i < 12 ? 7.0 : -1.0, 0, 0};
  run.snapshots[10].contacts = {push(kCar, kHips, kVehicles, {7000, 0, 0})};
  run.snapshots[12].contacts = {push(kCar, kHips, kVehicles, {-8000, 0, 0})};
  EXPECT_NEAR(value_of(measure(model, run), "delta_v_mps").value(), 8, 1e-9);
}

/// Exchanges of Kudlich-Slibar come a penetration time apart: 30 ms, or what the scene says. Those of less than 0.8 km/h are what
/// two that still lie against each other exchange.
TEST(VehicleMetrics, ExchangesThatFollowEachOtherByThePenetrationTimeAreOneEvent) {
  const auto delta_v = [](int apart, double penetration_time, double each) {  // [snapshots of 10 ms], [s], [m/s]
    Model model = person_and_car();
    model.bodies[kHips].person = -1;
    model.bodies[kHips].fixed = true;
    if (penetration_time > 0) {
      model.impacts.resize(1);
      model.impacts[0].body_a = kHips;
      model.impacts[0].body_b = kCar;
      model.impacts[0].penetration_time = penetration_time;
    }
    Recording run = standing_still(60);
    for (int i = 0; i < 60; ++i)
      run.snapshots[i].bodies.own()[kCar].V_WB.v = {i < 10               ? 10.0
                                                    : i < 10 + apart     ? 2.0
                                                    : i < 10 + 2 * apart ? 2.0 - each
                                                                         : 2.0 - 2 * each,
                                                    0, 0};
    for (const int at : {0, apart, 2 * apart}) {
      ContactRecord c = push(kCar, kHips, kVehicles, {at == 0 ? -8000.0 : -1000 * each, 0, 0});
      c.normal = {-1, 0, 0};
      c.exchange = true;
      run.snapshots[10 + at].contacts = {c};
    }
    return value_of(measure(model, run), "delta_v_mps").value();
  };
  EXPECT_NEAR(delta_v(4, 0, 0.25), 8.5, 0.01);
  EXPECT_NEAR(delta_v(8, 0, 0.25), 8, 0.01);
  EXPECT_NEAR(delta_v(8, 0.07, 0.25), 8.5, 0.01);
  EXPECT_NEAR(delta_v(4, 0, 0.2), 8, 0.01) << "below 0.8 km/h";
}

/// Pressed by somebody for a quarter of a second, and stopped by a block at its end: both do not fit into 250 ms.
TEST(VehicleMetrics, OfALongEventCountThe250MillisecondsThatChangeMostWithTheHardestPhase) {
  const Model model = car_person_and_block();
  Recording run = standing_still(60);
  double speed = 10;
  for (int i = 0; i < 60; ++i) {
    const bool person = i >= 5 && i < 29, block = i >= 30 && i < 35;
    speed -= (person ? 0.02 : 0) + (block ? 1 : 0);
    run.snapshots[i].bodies.own()[kCar].V_WB.v = {speed, 0, 0};
    if (person) run.snapshots[i].contacts.push_back(push(kHips, kCar, kOnVehicle, {20, 0, 0}));
    if (block) run.snapshots[i].contacts.push_back(push(kHead, kCar, kOnVehicle, {1000, 0, 0}));
  }
  std::vector<Metric> out;
  measure_vehicle(model, run, impacts_of(model, run), 0, out);
  // 250 ms that end with the block: its 5 m/s, and 19 of the 24 pushes of the person
  EXPECT_NEAR(value_of(out, "delta_v_mps").value(), 5 + 19 * 0.02, 1e-9);
}

/// What a trailer is struck with reaches the car that draws it: its own change of velocity in that phase, and no EES.
TEST(VehicleMetrics, WhatDrawsAStruckTrailerHasADeltaV) {
  Model model = person_and_car();
  model.settings.gravity.setZero();
  Body trailer = model.bodies[kCar];
  trailer.name = "trailer";
  trailer.vehicle = 1;
  model.bodies.push_back(trailer);
  model.vehicles.push_back(model.vehicles[0]);
  model.vehicles[1].name = "trailer";
  model.vehicles[1].body = 3;
  Joint coupling;
  coupling.parent = kCar;
  coupling.child = 3;
  model.joints = {coupling};
  Recording run = standing_still(20);
  for (int i = 0; i < 20; ++i) {
    auto& bodies = run.snapshots[i].bodies.own();
    bodies.resize(4, bodies[kCar]);
    bodies[kCar].V_WB.v = {i < 5 ? 0 : 2.0, 0, 0};
    run.snapshots[i].tyre_impulse = {Vec3::Zero(), Vec3::Zero()};
  }
  run.snapshots[5].contacts = {push(3, kHips, kOnVehicle, {4000, 0, 0})};
  std::vector<Metric> out;
  measure_vehicle(model, run, impacts_of(model, run), 0, out);
  EXPECT_NEAR(value_of(out, "delta_v_mps").value(), 2, kAlmost);
  EXPECT_NEAR(value_of(out, "pdof_deg").value(), 180, kAlmost);
  EXPECT_FALSE(value_of(out, "ees_mps"));
}

TEST(VehicleMetrics, UntouchedVehicleHasNone) {
  const Model model = person_and_car();
  Recording run;
  run.snapshots = {still(0), still(1)};
  std::vector<Metric> out;
  measure_vehicle(model, run, impacts_of(model, run), 0, out);
  for (const char* key : {"delta_v_mps", "pdof_deg", "ees_mps", "rest_x_m"}) EXPECT_FALSE(value_of(out, key)) << key;
  EXPECT_EQ(value_of(out, "path_m"), 0.0);
}

TEST(VehicleMetrics, RestIsPlaceHeadingAndLengthOfThePath) {
  const Model model = person_and_car();
  Recording run;
  run.interval = 1;
  for (int i = 0; i < 3; ++i) {
    run.snapshots.push_back(still(i));
    run.snapshots.back().bodies.own()[kCar].X_WB = {Vec3(3.0 * i, 4.0 * i, 0.5),
                                                    Quat(Eigen::AngleAxisd(-std::numbers::pi / 2 * i, Vec3::UnitZ()))};
  }
  run.events = {{1, "rest", kCar, -1, Vec3::Zero(), 0}};
  std::vector<Metric> out;
  measure_vehicle(model, run, {}, 0, out);
  EXPECT_NEAR(value_of(out, "rest_x_m").value(), 3, kAlmost);
  EXPECT_NEAR(value_of(out, "rest_y_m").value(), 4, kAlmost);
  EXPECT_NEAR(value_of(out, "rest_heading_deg").value(), -90, 1e-9);
  EXPECT_NEAR(value_of(out, "path_m").value(), 10, kAlmost);
}

/// A car slides along -y at 12 m/s on its wheels until it is tripped at 1 s. It rolls there like a cylinder, to its right, over so
/// many quarter turns in 2 s, slows down evenly and rests at 3 s. Meanwhile it turns as far to the side as said.
constexpr double kTripSpeed = 12, kRollTime = 2;  // [m/s], [s]

Recording rolled_like_a_cylinder(double quarters, double yaw_degrees = 0) {
  Recording run;
  run.interval = 0.01;
  for (int i = 0; i <= 350; ++i) {
    Snapshot s = still(0.01 * i);
    const double since = std::clamp(s.time - 1, 0.0, kRollTime), share = since / kRollTime;
    BodyState& car = s.bodies.own()[kCar];
    const auto about = [](double quarter_turns, const Vec3& axis) {
      return Quat(Eigen::AngleAxisd(quarter_turns * std::numbers::pi / 2, axis));
    };
    car.X_WB.q = about(share * yaw_degrees / 90, Vec3::UnitZ()) * about(share * quarters, Vec3::UnitX());
    car.X_WB.p = {0, -kTripSpeed * (std::min(s.time, 1.0) + since * (1 - share / 2)), 0.5};
    car.V_WB.v = {0, -kTripSpeed * (1 - share), 0};
    for (int w = 0; w < 2; ++w) {
      WheelRecord wheel;
      wheel.wheel = w;
      wheel.load = i <= 100 ? 2000 : 0;
      s.wheels.push_back(wheel);
    }
    run.snapshots.push_back(s);
  }
  run.events = {{3, "rest", kCar, -1, Vec3::Zero(), 0}};
  return run;
}

Model car_with_a_track() {
  Model model = person_and_car();
  model.vehicles[0].wheels.push_back(model.vehicles[0].wheels[0]);
  model.vehicles[0].wheels[1].hub_B.y() *= -1;
  return model;
}

std::vector<Metric> rollover_of(const Model& model, const Recording& run) {
  std::vector<Metric> out;
  measure_rollover(model, run, impacts_of(model, run), 0, out);
  return out;
}

TEST(Rollover, OfACylinderHasItsQuarterTurnsAndTheDragThatStopsIt) {
  const Model model = car_with_a_track();
  for (const double quarters : {1.0, 2.0, 3.0, 4.0, -6.0, 9.0})
    for (const double yaw : {0.0, 120.0}) {
      const std::vector<Metric> out = rollover_of(model, rolled_like_a_cylinder(quarters, yaw));
      EXPECT_EQ(value_of(out, "quarter_turns"), std::abs(quarters)) << yaw;
      EXPECT_NEAR(value_of(out, "trip_s").value(), 1, kAlmost);
      // v^2 / 2 a and a / g with a = v / t
      EXPECT_NEAR(value_of(out, "roll_distance_m").value(), kTripSpeed * kRollTime / 2, 1e-9);
      EXPECT_NEAR(value_of(out, "roll_drag_factor").value(), kTripSpeed / kRollTime / model.settings.gravity.norm(), 1e-9);
    }
  // what it lies on is seldom level: to the nearest quarter
  EXPECT_EQ(value_of(rollover_of(model, rolled_like_a_cylinder(2.3)), "quarter_turns"), 2.0);
}

/// Down a bank gravity gives what the ground takes: a fall of a tenth of the way is a tenth more drag.
TEST(Rollover, DragDownABankHasTheFallInIt) {
  Model model = car_with_a_track();
  const Recording run = rolled_like_a_cylinder(4, 0);
  const double level = value_of(rollover_of(model, run), "roll_drag_factor").value(), g = model.settings.gravity.norm();
  model.settings.gravity = {0, -0.1 * g, -std::sqrt(0.99) * g};
  EXPECT_NEAR(value_of(rollover_of(model, run), "roll_drag_factor").value(), level + 0.1, 1e-9) << "ground tilted as a whole";
  model.settings.gravity = {0, 0, -g};
  model.ground.plane = false;
  model.ground.terrain = std::make_shared<TriangleMesh>(
      std::vector<Vec3>{{-50, -200, -20}, {50, -200, -20}, {50, 0, 0}, {-50, 0, 0}}, std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
  EXPECT_NEAR(value_of(rollover_of(model, run), "roll_drag_factor").value(), level + 0.1, 1e-6);
}

/// Back on its wheels at 2 m/s it has rolled over, however far it coasts.
TEST(Rollover, EndsWhereItStandsOnItsWheelsForGood) {
  const Model model = car_with_a_track();
  Recording run = rolled_like_a_cylinder(4);
  run.events.clear();
  const double down = 1 + kRollTime - 1.0 / 3;  // [s] when it has 2 of its 12 m/s left
  for (Snapshot& s : run.snapshots) {
    BodyState& car = s.bodies.own()[kCar];
    if (s.time < down) continue;
    for (WheelRecord& wheel : s.wheels) wheel.load = 2000;
    car.X_WB.p.y() = run.at(down).bodies[kCar].X_WB.p.y() - 2 * (s.time - down);
    car.V_WB.v = {0, -2, 0};
  }
  const std::vector<Metric> out = rollover_of(model, run);
  const double slowing = kTripSpeed / kRollTime, way = (kTripSpeed * kTripSpeed - 4) / (2 * slowing);
  EXPECT_NEAR(value_of(out, "roll_distance_m").value(), way, 0.03) << "to the recorded interval";
  EXPECT_NEAR(value_of(out, "roll_drag_factor").value(), slowing / model.settings.gravity.norm(), 1e-3);
}

TEST(Rollover, TellsHowOftenAndHowHardTheBodyworkCameDown) {
  Model model = car_with_a_track();
  MeshShape& shape = std::get<MeshShape>(model.bodies[kCar].shape);
  // two triangles a side of the box: the top is the roof
  Panels panels(shape.mesh->triangles().size(), Panel::side);
  panels[2] = panels[3] = Panel::roof;
  shape.panels = std::make_shared<Panels>(panels);
  Recording run = rolled_like_a_cylinder(4);
  EXPECT_EQ(value_of(rollover_of(model, run), "ground_strikes"), 0.0);
  EXPECT_FALSE(value_of(rollover_of(model, run), "ground_strike_s"));
  const auto strike = [&](std::size_t i, double amount) {
    ContactRecord c = push(kCar, -1, {ShapeKind::mesh, ShapeKind::plane}, {0, 0, amount});
    const BodyState& car = run.snapshots[i].bodies[kCar];
    c.point = car.X_WB * Vec3(0, 0, 0.5);  // the middle of its top
    c.normal = -(car.X_WB.q * Vec3::UnitZ());
    c.begun = run.snapshots[i].time - 0.004;
    run.snapshots[i].contacts.push_back(c);
  };
  strike(80, 9000);                                          // before the trip
  for (const std::size_t i : {190u, 191u}) strike(i, 1500);  // 3 m/s in two intervals
  strike(250, 800);                                          // on its side
  for (std::size_t i = 260; i < 290; ++i) strike(i, 150);    // lying on it: half as much again as its weight
  strike(340, 5000);                                         // after rest
  const std::vector<Metric> out = rollover_of(model, run);
  EXPECT_EQ(value_of(out, "ground_strikes"), 2.0);
  EXPECT_NEAR(value_of(out, "ground_strike_s").value(), 1.896, kAlmost);
  EXPECT_NEAR(value_of(out, "ground_strike_mps").value(), 3 - 0.02 * model.settings.gravity.norm(), kAlmost) << "less its weight";
  const auto panel = std::find_if(out.begin(), out.end(), [](const Metric& m) { return m.key == "ground_strike_panel"; });
  ASSERT_NE(panel, out.end());
  EXPECT_EQ(panel->text, "roof");
  EXPECT_TRUE(value_of(out, "roll_drag_factor")) << "the ground is what drags";
}

TEST(GroundStrike, IsToldOfACarThatFallsWithoutRollingOver) {
  const Model model = car_with_a_track();
  Recording run = rolled_like_a_cylinder(0);
  EXPECT_FALSE(value_of(rollover_of(model, run), "ground_strikes"));
  ContactRecord c = push(kCar, -1, {ShapeKind::mesh, ShapeKind::plane}, {0, 0, 9000});
  c.begun = run.snapshots[79].time;
  run.snapshots[80].contacts.push_back(c);
  const std::vector<Metric> out = rollover_of(model, run);
  EXPECT_EQ(value_of(out, "ground_strikes"), 1.0);
  EXPECT_NEAR(value_of(out, "ground_strike_mps").value(), 9 - 0.01 * model.settings.gravity.norm(), kAlmost);
  EXPECT_FALSE(value_of(out, "quarter_turns"));
}

TEST(Rollover, IsNoneOfWhoTipsAndFallsBackPitchesOrHasTwoWheels) {
  const Model model = car_with_a_track();
  EXPECT_TRUE(rollover_of(model, rolled_like_a_cylinder(0.4)).empty());
  Recording back = rolled_like_a_cylinder(0.8);
  for (Snapshot& s : back.snapshots)
    if (s.time > 2.9) s.bodies.own()[kCar].X_WB.q = Quat::Identity();
  EXPECT_TRUE(rollover_of(model, back).empty());
  Recording nose = rolled_like_a_cylinder(0);
  for (Snapshot& s : nose.snapshots) s.bodies.own()[kCar].X_WB.q = Quat(Eigen::AngleAxisd(std::min(s.time, 1.5), Vec3::UnitY()));
  EXPECT_TRUE(rollover_of(model, nose).empty());
  // on over its nose onto its roof: upside down, and has not rolled
  for (Snapshot& s : nose.snapshots) s.bodies.own()[kCar].X_WB.q = Quat(Eigen::AngleAxisd(std::min(s.time, 3.0), Vec3::UnitY()));
  EXPECT_TRUE(rollover_of(model, nose).empty());
  EXPECT_TRUE(rollover_of(person_and_car(), rolled_like_a_cylinder(4)).empty()) << "it has no wheels on its right";
}

TEST(Rollover, StillUnderWayHasNoDragFactorAndOneThatStartsInTheAirTripsAtTheStart) {
  const Model model = car_with_a_track();
  Recording run = rolled_like_a_cylinder(4);
  run.events.clear();
  EXPECT_TRUE(value_of(rollover_of(model, run), "roll_distance_m"));
  EXPECT_FALSE(value_of(rollover_of(model, run), "roll_drag_factor"));
  for (Snapshot& s : run.snapshots) s.wheels.clear();
  EXPECT_EQ(value_of(rollover_of(model, run), "trip_s"), 0.0);
  EXPECT_NEAR(value_of(rollover_of(model, run), "roll_distance_m").value(), kTripSpeed * (1 + kRollTime / 2), 1e-9);
}

TEST(AbsentMetrics, AVehicleSaysWhichOfTheReasonsIsItsOwn) {
  Model model = person_and_car();
  Recording run = standing_still(8);
  const auto reason = [&](const char* key) {
    std::vector<Metric> there;
    measure_vehicle(model, run, impacts_of(model, run), 0, there);
    for (const AbsentMetric& a : absent_metrics(model, run, there))
      if (a.key == key && a.object == "car") return a.reason;
    return std::string();
  };
  EXPECT_EQ(reason("delta_v_mps"), "it touched no person, vehicle or object");
  EXPECT_EQ(reason("ees_mps"), "");
  run.snapshots[5].contacts = {push(kHips, kCar, kOnVehicle, {100, 0, 0})};
  for (std::size_t i = 5; i < 8; ++i) run.snapshots[i].bodies.own()[kCar].V_WB.v = {-0.1, 0, 0};
  EXPECT_EQ(reason("ees_mps"), "its hardest impact was with a person, who deforms no car");
  EXPECT_EQ(reason("pdof_deg"), "");
  model.bodies[kCar].fixed = true;
  EXPECT_EQ(reason("delta_v_mps"), "it is fixed");
}

}  // namespace
}  // namespace engine
