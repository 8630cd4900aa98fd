// What is measured of vehicles, and the table of impacts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/measure/impacts.h"
#include "engine/measure/phases.h"
#include "tests/engine/hand_made_runs.h"

namespace engine {
namespace {

/// So many snapshots at intervals of 0.01 s.
Recording standing_still(int instants) {
  Recording run;
  run.interval = 0.01;
  for (int i = 0; i < instants; ++i) run.snapshots.push_back(still(0.01 * i));
  return run;
}

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
  EXPECT_EQ(hardest_impact(impacts, 0), &impacts[0]);
  EXPECT_EQ(hardest_impact(impacts, 1), nullptr);
  std::vector<Metric> out;
  measure_vehicle(model, run, impacts, 0, out);
  EXPECT_NEAR(value_of(out, "delta_v_mps").value(), 6, 1e-9);
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

/// A car of 1000 kg at 10 m/s and a block of a given mass that stands; they lose `energy` at 0.05 s.
std::vector<Impact> car_against_block(double mass, double energy, double stiffness = 400e3, bool fixed = false, int wheels = 4,
                                      double height = 0.6, bool track = false) {
  Model model = person_and_car();
  model.vehicles[0].wheels.resize(static_cast<std::size_t>(wheels));
  if (track) model.vehicles[0].wheels.back().hub_B.y() = -model.vehicles[0].wheels.front().hub_B.y();
  Body& block = model.bodies[kHips];
  block.person = -1;
  block.mass = mass;
  block.fixed = fixed;
  block.surface.stiffness = stiffness;
  block.shape = model.bodies[kCar].shape;
  Recording run = standing_still(20);
  for (int i = 0; i < 20; ++i) {
    run.snapshots[i].bodies.own()[kCar].V_WB.v = {i < 5 ? 10.0 : 4.0, 0, 0};
  }
  ContactRecord c = push(kCar, kHips, kVehicles, {-6000, 0, 0});
  c.normal = {-1, 0, 0};
  c.point = {2, 0, height};
  c.friction_limit = 0.3 * c.normal_impulse;
  c.energy_lost = energy;
  c.begun = 0.043;
  run.snapshots[5].contacts = {c};
  return impacts_of(model, run);
}

TEST(ImpactTable, EnergyGoesToTheSofterOrLighterAndNotByHalves) {
  // what is 4532 times as heavy takes a 4533rd
  const Impact by_mass = car_against_block(4.532e6, 20e3).at(0);
  EXPECT_NEAR(by_mass.a.ees, std::sqrt(2 * 20e3 / 1000 * 4532.0 / 4533), 1e-9);
  EXPECT_STREQ(by_mass.ees_rule, "by mass");
  const Impact by_stiffness = car_against_block(1000, 20e3, 1200e3).at(0);
  EXPECT_NEAR(by_stiffness.a.ees, std::sqrt(2 * 20e3 / 1000 * 0.75), 1e-9);
  EXPECT_STREQ(by_stiffness.ees_rule, "by stiffness");
  const Impact barrier = car_against_block(1000, 20e3, 400e3, true).at(0);
  EXPECT_NEAR(barrier.a.ees, std::sqrt(2 * 20e3 / 1000), 1e-9);
  EXPECT_STREQ(barrier.ees_rule, "all to the one that moves");
}

/// Hubs are 0.3 m above the ground: what stops wheels at half of that crushes no bodywork, and has no speed that its energy equals.
TEST(ImpactTable, WheelsAgainstAKerbHaveNoEnergyEquivalentSpeed) {
  const Impact kerb = car_against_block(1000, 20e3, 400e3, true, 1, 0.15).at(0);
  EXPECT_TRUE(std::isnan(kerb.a.ees));
  EXPECT_STREQ(kerb.ees_rule, "");
  EXPECT_NEAR(kerb.energy_lost, 20e3, kAlmost) << "which stands in the row";
  EXPECT_NEAR(car_against_block(1000, 20e3, 400e3, true, 1, 0.35).at(0).a.ees, std::sqrt(2 * 20e3 / 1000), 1e-9) << "a wall";
  EXPECT_FALSE(std::isnan(car_against_block(1000, 20e3, 400e3, true, 1, 0.29).at(0).a.ees)) << "the widest line of a car";
  EXPECT_FALSE(std::isnan(car_against_block(1000, 20e3, 400e3, false, 1, 0.15).at(0).a.ees)) << "under another's bumper";
}

TEST(ImpactTable, ATwoWheelerAndACarShareNoEnergyByARuleOfCars) {
  const Impact by_mass = car_against_block(500, 20e3, 400e3, false, 2).at(0);
  EXPECT_TRUE(std::isnan(by_mass.a.ees));
  EXPECT_STREQ(by_mass.ees_rule, "");
  EXPECT_STREQ(car_against_block(500, 20e3, 1200e3, false, 2).at(0).ees_rule, "by stiffness") << "where the scene tells them apart";
  EXPECT_STREQ(car_against_block(500, 20e3, 400e3, true, 2).at(0).ees_rule, "all to the one that moves");
  EXPECT_STREQ(car_against_block(500, 20e3, 400e3, false, 2, 0.6, true).at(0).ees_rule, "by mass") << "a trailer of one axle";
}

TEST(ImpactTable, FrictionIsThatOfEachContactAlongItsOwnSurface) {
  // a limb lies in an edge: two faces at right angles, each with half of the friction it could have; dents make it 0.4 and 0.6
  Model model = person_and_car();
  Recording run = standing_still(4);
  for (const Vec3& normal : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitZ())}) {
    ContactRecord c = push(kHips, kCar, kOnVehicle, 100 * normal + (normal.x() > 0 ? 20 : 30) * Vec3::UnitY());
    c.normal = normal;
    c.normal_impulse = 100;
    c.tangential_impulse = normal.x() > 0 ? 20 : 30;
    c.friction_limit = 2 * c.tangential_impulse;
    run.snapshots[1].contacts.push_back(c);
  }
  const std::vector<Impact> all = impacts_of(model, run);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_NEAR(all[0].friction_used, 0.25, kAlmost);
  EXPECT_NEAR(all[0].friction_limit, 0.5, kAlmost);
}

TEST(ImpactTable, APhaseLastsAQuarterOfASecondAtMost) {
  Model model = person_and_car();
  Recording run = standing_still(60);
  for (int i = 0; i < 60; ++i) {
    if (i == 0) continue;
    run.snapshots[i].contacts = {push(kHips, kCar, kOnVehicle, {100, 0, 0})};
    run.snapshots[i].contacts[0].begun = 0.01 * (i - 1) + 1e-3;
  }
  const std::vector<Impact> all = impacts_of(model, run);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_LE(all[0].duration, 0.25);
  EXPECT_GT(all[0].duration, 0.22);
}

TEST(ImpactTable, ARowHasTheCollisionFromBothSides) {
  const std::vector<Impact> all = car_against_block(500, 0);
  ASSERT_EQ(all.size(), 1u);
  const Impact& i = all[0];
  EXPECT_EQ(i.time, 0.043);
  EXPECT_NEAR(i.duration, 0.05 - 0.043, 1e-12);
  EXPECT_NEAR(i.closing_speed, 10, kAlmost);
  EXPECT_NEAR(i.impulse.x(), -6000, kAlmost);
  EXPECT_NEAR(i.a.speed_before, 10, kAlmost);
  EXPECT_NEAR(i.a.speed_after, 4, kAlmost);
  EXPECT_NEAR(i.friction_used, 0, kAlmost);
  EXPECT_NEAR(i.friction_limit, 0.3, kAlmost);
  EXPECT_STREQ(i.law, "default_auto");
}

/// A car at 10 m/s along x is stopped by a push of 10 m/s within the fifth hundredth of a second, turned as said.
std::vector<Impact> stopped_car(const Quat& attitude) {
  Model model = person_and_car();
  model.settings.gravity.setZero();
  Recording run = standing_still(10);
  for (int i = 0; i < 10; ++i) {
    run.snapshots[i].bodies.own()[kCar].X_WB.q = attitude;
    run.snapshots[i].bodies.own()[kCar].V_WB.v = i < 5 ? Vec3(10, 0, 0) : Vec3(Vec3::Zero());
  }
  model.bodies[kHips].person = -1;
  run.snapshots[5].contacts = {push(kCar, kHips, kVehicles, {-10000, 0, 0})};
  return impacts_of(model, run);
}

TEST(ImpactTable, AVehicleOnItsSideOrRoofHasNoDirectionOfForce) {
  const auto pdof = [](const Vec3& axis, double degrees) {
    return stopped_car(Quat(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis))).at(0).a.pdof;
  };
  EXPECT_NEAR(pdof(Vec3::UnitZ(), 30), 30, 1e-9) << "it heads to the left of the way it goes: struck from its right";
  // a car that dives or leans is struck from where it would be standing level: the direction lies in the plane of the road
  EXPECT_NEAR(pdof(Vec3::UnitX(), 30), 0, 1e-9);
  EXPECT_NEAR(pdof(Vec3::UnitY(), 30), 0, 1e-9);
  for (const double lying : {90.0, -90.0, 180.0}) EXPECT_TRUE(std::isnan(pdof(Vec3::UnitX(), lying))) << lying;
}

TEST(ImpactTable, WhoIsStruckClosesAlongTheFirstTouchAndNotAlongTheMeanOfTheWrap) {
  const Model model = person_and_car();
  Recording run = standing_still(8);
  for (int i = 0; i < 8; ++i) {
    run.snapshots[i].bodies.own()[kCar].V_WB.v = {11, 0, 0};
    run.snapshots[i].bodies.own()[kHips].V_WB.v = {0, 4, 0};
  }
  // struck by the front, then laid on the bonnet: the normal turns from level to upright
  for (int i = 2; i < 6; ++i) {
    ContactRecord c = push(kHips, kCar, kOnVehicle, i == 2 ? Vec3(100, 0, 0) : Vec3(0, 0, 200));
    c.normal = i == 2 ? Vec3::UnitX() : Vec3::UnitZ();
    c.begun = run.snapshots[static_cast<std::size_t>(i - 1)].time;
    run.snapshots[static_cast<std::size_t>(i)].contacts = {c};
  }
  const std::vector<Impact> all = impacts_of(model, run);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_LT(all[0].normal.z(), -0.9) << "from the person to the car, by impulse: nobody came from above";
  EXPECT_NEAR(all[0].closing_speed, 11, kAlmost);
  run.events = {{run.snapshots[1].time, "first_contact", kHips, kCar, Vec3::Zero(), 10.9}};
  EXPECT_EQ(impacts_of(model, run).at(0).closing_speed, 10.9) << "as the event of that touch says";
}

/// A car backs at 4 m/s against somebody who stands. A hand is met first, and too softly for a collision; the trunk 30 ms later,
/// along with the hand by then. Half a second later the car drags who lies under it.
TEST(ImpactTable, AClosingSpeedIsThatOfTheTouchThatLedToThePhaseAndWhatIsDraggedHasNone) {
  const Model model = person_and_car();
  Recording run = standing_still(80);
  for (int i = 0; i < 80; ++i) {
    run.snapshots[i].bodies.own()[kCar].V_WB.v = {-4, 0, 0};
    for (const int b : {kHips, kHead}) run.snapshots[i].bodies.own()[b].V_WB.v = {i < 12 ? (b == kHips ? -3.5 : 0) : -4.1, 0, 0};
  }
  const auto touch = [&](std::size_t i, int part, double amount) {
    ContactRecord c = push(part, kCar, kOnVehicle, {-amount, 0, 0});
    c.normal = -Vec3::UnitX();
    c.begun = run.snapshots[i - 1].time;
    run.snapshots[i].contacts.push_back(c);
  };
  for (const std::size_t i : {9u, 10u, 11u}) touch(i, kHead, 0.1);
  for (const std::size_t i : {12u, 13u, 14u, 60u, 61u, 62u}) touch(i, kHips, 40);
  const std::vector<Impact> all = impacts_of(model, run);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_GE(all[0].time, 0.1) << "what the hand exchanged is no collision yet";
  EXPECT_NEAR(all[0].closing_speed, 4, kAlmost);
  EXPECT_TRUE(std::isnan(all[1].closing_speed)) << "it goes ahead of the car by 0.1 m/s";
}

TEST(ImpactTable, AnExchangeAtAnInstantHasTimeAndClosingSpeedOfItsEventAndLastsNone) {
  Model model = person_and_car();
  model.bodies[kHips].person = -1;
  Recording run = standing_still(8);
  ContactRecord c = push(kCar, kHips, kVehicles, {-6000, 0, 0});
  c.exchange = true;
  c.begun = 0.0437;
  run.snapshots[5].contacts = {c};
  run.events = {{0.0437, "impact", kCar, kHips, Vec3::Zero(), 10.3}};
  const std::vector<Impact> all = impacts_of(model, run);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].time, 0.0437);
  EXPECT_EQ(all[0].closing_speed, 10.3);
  EXPECT_EQ(all[0].duration, 0.0) << "not the rest of the recorded interval";
}

TEST(ToldEvents, ARigidCollisionIsToldOnceAPair) {
  Model model = person_and_car();
  model.bodies[kHips].person = -1;
  Recording run = standing_still(80);
  for (const std::size_t i : {5u, 60u}) {  // two phases of the same pair
    run.snapshots[i].contacts = {push(kCar, kHips, kVehicles, {-6000, 0, 0})};
    run.snapshots[i].contacts[0].begun = run.snapshots[i - 1].time;
  }
  run.events = {{0.3, "rest", kCar, -1, Vec3::Zero(), 0}};
  const std::vector<Event> told = told_events(model, run);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].kind, "collision");
  EXPECT_EQ(told[0].time, run.snapshots[4].time);
  EXPECT_EQ(std::minmax(told[0].body_a, told[0].body_b), std::minmax(kCar, kHips));
  run.events.push_back({0.04, "impact", kCar, kHips, Vec3::Zero(), 10});
  EXPECT_EQ(told_events(model, run).size(), 2u) << "Kudlich-Slibar tells its own";
  model.bodies[kHips].person = 0;
  run.events.clear();
  EXPECT_TRUE(told_events(model, run).empty()) << "a person has its first contact";
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
  for (std::size_t i = 260; i < 290; ++i) strike(i, 40);     // scraping: 0.08 m/s within 20 ms
  strike(340, 5000);                                         // after rest
  const std::vector<Metric> out = rollover_of(model, run);
  EXPECT_EQ(value_of(out, "ground_strikes"), 2.0);
  EXPECT_NEAR(value_of(out, "ground_strike_s").value(), 1.896, kAlmost);
  EXPECT_NEAR(value_of(out, "ground_strike_mps").value(), 3, kAlmost);
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
  EXPECT_NEAR(value_of(out, "ground_strike_mps").value(), 9, kAlmost);
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
