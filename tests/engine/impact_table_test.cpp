// The table of impacts, and the events told of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/measure/impacts.h"
#include "engine/measure/phases.h"
#include "tests/engine/hand_made_runs.h"

namespace engine {
namespace {

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

/// What draws a light trailer stops with it what runs into it: by mass the trailer alone would have taken up nearly all of that,
/// and its speed would pass the one they closed at.
TEST(ImpactTable, WhatIsCoupledSharesNoEnergyByARuleOfCarsByThemselves) {
  Model model = person_and_car();
  model.bodies[kHead].person = model.bodies[kHips].person = -1;
  model.persons.clear();
  model.bodies[kHips].mass = 300;
  model.bodies[kHips].vehicle = 1;
  model.bodies[kHead].mass = 1500;
  Vehicle trailer;
  trailer.name = "trailer";
  trailer.body = kHips;
  model.vehicles.push_back(trailer);
  Joint coupling;
  coupling.parent = kHead;
  coupling.child = kHips;
  Recording run = standing_still(20);
  for (int i = 0; i < 5; ++i) run.snapshots[i].bodies.own()[kCar].V_WB.v = {13.9, 0, 0};
  ContactRecord c = push(kCar, kHips, kVehicles, {-9000, 0, 0});
  c.normal = {-1, 0, 0};
  c.energy_lost = 0.5 * 1000 * 1800 / 2800.0 * 13.9 * 13.9;  // a plastic blow on both
  run.snapshots[5].contacts = {c};
  EXPECT_GT(impacts_of(model, run).at(0).a.ees, 13.9) << "were it not coupled";
  model.joints = {coupling};
  const Impact coupled = impacts_of(model, run).at(0);
  for (const ImpactSide* side : {&coupled.a, &coupled.b}) EXPECT_TRUE(std::isnan(side->ees));
  EXPECT_STREQ(coupled.ees_rule, "");
  EXPECT_THAT(coupled.no_ees, testing::HasSubstr("coupled"));
  model.bodies[kHips].surface.stiffness = 1200e3;
  EXPECT_STREQ(impacts_of(model, run).at(0).ees_rule, "by stiffness") << "where the scene tells them apart";
}

/// What a rider gives through the holds is in the energy that a wall takes from a motorcycle: none is told of the one.
TEST(ImpactTable, ARidersEnergyIsNotThatOfTheMountAlone) {
  Model model = person_and_car();
  model.bodies[kHips].person = -1;
  model.bodies[kHips].fixed = true;
  model.bodies[kHips].shape = model.bodies[kCar].shape;
  model.bodies[kHead].mass = 500;
  model.persons[0].bodies = {kHead};
  Joint hold;
  hold.parent = kCar;
  hold.child = kHead;
  Recording run = standing_still(20);
  for (int i = 0; i < 5; ++i) run.snapshots[i].bodies.own()[kCar].V_WB.v = run.snapshots[i].bodies.own()[kHead].V_WB.v = {10, 0, 0};
  ContactRecord c = push(kCar, kHips, kVehicles, {-15000, 0, 0});
  c.normal = {-1, 0, 0};
  c.point = {2, 0, 0.6};
  c.energy_lost = 0.5 * 1500 * 100;
  run.snapshots[5].contacts = {c};
  EXPECT_GT(impacts_of(model, run).at(0).a.ees, 12) << "were it not held";
  model.joints = {hold};
  const Impact held = impacts_of(model, run).at(0);
  EXPECT_TRUE(std::isnan(held.a.ees));
  EXPECT_THAT(held.no_ees, testing::HasSubstr("coupled"));
}

TEST(ImpactTable, NoCollisionIsSaidToLoseLessThanNothing) {
  EXPECT_TRUE(std::isnan(car_against_block(500, -1.5).at(0).energy_lost));
  EXPECT_STREQ(car_against_block(500, -1.5).at(0).ees_rule, "");
  EXPECT_EQ(car_against_block(500, 0).at(0).energy_lost, 0);
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

/// A body of 5 kg, nobody's part, where the car of other runs is.
constexpr int kLog = kCar;

Model person_and_log() {
  Model model = person_and_car();
  model.vehicles.clear();
  model.bodies[kLog].vehicle = -1;
  model.bodies[kLog].mass = 5;
  model.bodies[kLog].shape = HyperEllipsoid{};
  return model;
}

/// The log comes at 10 m/s along x, strikes the head at 0.05 s and goes on at 2 m/s; the head takes up what it has lost.
Recording log_strikes_head() {
  Recording run = standing_still(20);
  for (int i = 0; i < 20; ++i) {
    run.snapshots[i].bodies.own()[kLog].V_WB.v = {i < 5 ? 10.0 : 2.0, 0, 0};
    run.snapshots[i].bodies.own()[kHead].V_WB.v = {i < 5 ? 0.0 : 4.0, 0, 0};
  }
  ContactRecord c = push(kHead, kLog, ShapePair{ShapeKind::round, ShapeKind::round}, {40, 0, 0});
  c.normal = Vec3::UnitX();
  c.begun = 0.043;
  run.snapshots[5].contacts = {c};
  return run;
}

TEST(ImpactTable, AnObjectThatStrikesAPersonHasARowAndAnEvent) {
  const Model model = person_and_log();
  const Recording run = log_strikes_head();
  const std::vector<Impact> all = impacts_of(model, run);
  ASSERT_EQ(all.size(), 1u);
  const Impact& i = all[0];
  EXPECT_EQ(i.a.party.bodies, std::vector<int>{kLog});
  EXPECT_EQ(i.b.name, "pedestrian");
  EXPECT_EQ(i.time, 0.043);
  EXPECT_NEAR(i.closing_speed, 10, kAlmost);
  EXPECT_NEAR(i.relative_speed, 10, kAlmost);
  EXPECT_NEAR(i.impulse.x(), -40, kAlmost) << "on the log";
  EXPECT_NEAR(i.b.speed_after, 1, kAlmost) << "40 N s on 40 kg";
  for (const ImpactSide* side : {&i.a, &i.b}) EXPECT_TRUE(std::isnan(side->ees) && std::isnan(side->pdof)) << "those of vehicles";
  const std::vector<Event> told = told_events(model, run);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].kind, "collision");
  EXPECT_EQ(told[0].body_a, kLog);
  EXPECT_EQ(told[0].body_b, kHead) << "the part that was struck";
  EXPECT_NEAR(told[0].value, 10, kAlmost);
}

/// The ground bears who stands while a vehicle brushes them: their delta-v is what the vehicle gave, and not gravity's 50 ms.
TEST(ImpactTable, APersonsDeltaVIsWhatThePairGaveIt) {
  Model model = person_and_car();
  Recording run = standing_still(20);
  double mass = 0;
  for (const int b : model.persons[0].bodies) mass += model.bodies[b].mass;
  for (const int i : {5, 8}) {
    ContactRecord c = push(kCar, kHips, kVehicles, {-20, 0, -5});
    c.normal = {-1, 0, 0};
    c.begun = 0.005 * i - 0.002;
    run.snapshots[static_cast<std::size_t>(i)].contacts = {c};
  }
  const Impact impact = impacts_of(model, run).at(0);
  const ImpactSide& person = impact.a.party.person >= 0 ? impact.a : impact.b;
  const ImpactSide& car = impact.a.party.person >= 0 ? impact.b : impact.a;
  const double given = std::abs(impact.impulse.x());
  EXPECT_NEAR(person.delta_v.norm(), given / mass, 1e-12);
  EXPECT_NEAR(person.own_delta_v.norm(), given / mass, 1e-12);
  EXPECT_NEAR(car.own_delta_v.norm(), given / model.bodies[kCar].mass, 1e-12);
}

/// A car presses a person of 40 kg with 200 N s against a wall, which gives 170 back, and the pavement they stand on holds with 10:
/// they change their velocity by 0.5 m/s, and not by 5. That it bears them is no blow.
TEST(ImpactTable, WhoIsPressedFromTwoSidesHasTheDeltaVOfBoth) {
  constexpr int kWall = 3, kPavement = 4;
  Model model = person_and_car();
  model.bodies.resize(5);
  model.bodies[kWall].fixed = model.bodies[kPavement].fixed = true;
  Recording run = standing_still(20);
  for (Snapshot& s : run.snapshots) s.bodies.own().resize(5);
  const auto with_normal = [](ContactRecord c, const Vec3& normal) {
    c.normal = normal;
    return c;
  };
  run.snapshots[5].contacts = {
      with_normal(push(kHips, kCar, kOnVehicle, {200, 0, 0}), Vec3::UnitX()),
      with_normal(push(kHips, kWall, kOnVehicle, {-170, 0, 0}), -Vec3::UnitX()),
      with_normal(push(kHips, kPavement, kOnVehicle, {-10, 0, 40}), Vec3::UnitZ()),
  };
  const std::vector<Impact> impacts = impacts_of(model, run);
  const auto with_car =
      std::find_if(impacts.begin(), impacts.end(), [](const Impact& i) { return i.a.party.vehicle == 0 && i.b.party.person == 0; });
  ASSERT_NE(with_car, impacts.end());
  EXPECT_NEAR(with_car->b.delta_v.x(), 0.5, kAlmost);
  EXPECT_NEAR(with_car->b.own_delta_v.x(), 5, kAlmost);
}

/// A wheel pushes who lies under it along the road with 200 N s, and the road holds with 180.
TEST(ImpactTable, TheRoadHoldsWhoLiesUnderAWheel) {
  Model model = person_and_car();
  Recording run = standing_still(20);
  run.snapshots[5].contacts = {push(kHips, kCar, ShapePair{ShapeKind::round, ShapeKind::tyre}, {200, 0, -300}),
                               push(kHips, -1, kOnGround, {-180, 0, 300})};
  const Impact impact = impacts_of(model, run).at(0);
  EXPECT_NEAR((impact.a.party.person >= 0 ? impact.a : impact.b).delta_v.norm(), 0.5, kAlmost);
}

TEST(ImpactTable, AFixtureStrikesNobody) {
  Model model = person_and_log();
  model.bodies[kLog].fixed = true;
  EXPECT_TRUE(impacts_of(model, log_strikes_head()).empty());
}

TEST(ImpactTable, TwoPersonsThatRunIntoEachOtherHaveARow) {
  Model model = person_and_log();
  model.bodies[kLog].person = 1;
  model.persons.push_back({"other", {kLog}});
  const std::vector<Impact> all = impacts_of(model, log_strikes_head());
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].a.name, "pedestrian");
  EXPECT_EQ(all[0].b.name, "other");
  EXPECT_NEAR(all[0].closing_speed, 10, kAlmost);
}

/// Thrice its weight in 20 ms is more than 0.8 km/h of the log; but nothing moves.
TEST(ImpactTable, WhoStandsOnSomethingIsNotStruckByIt) {
  const Model model = person_and_log();
  Recording run = standing_still(60);
  for (int i = 1; i < 60; ++i)
    run.snapshots[i].contacts = {push(kHips, kLog, ShapePair{ShapeKind::round, ShapeKind::round}, {0, 0, 4})};
  EXPECT_TRUE(impacts_of(model, run).empty());
  EXPECT_TRUE(told_events(model, run).empty());
}

TEST(ImpactTable, WhatIsHeldStrikesNobodyBeforeItIsLetGo) {
  Model model = person_and_log();
  Joint grip;
  grip.parent = kHips;
  grip.child = kLog;
  model.joints = {grip};
  Recording run = log_strikes_head();
  EXPECT_TRUE(impacts_of(model, run).empty());
  run.events = {{0.02, "joint_broken", kLog, kHips, Vec3::Zero(), 0}};
  EXPECT_EQ(impacts_of(model, run).size(), 1u);
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

}  // namespace
}  // namespace engine
