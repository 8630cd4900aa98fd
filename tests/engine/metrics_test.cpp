#include "engine/measure/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>

#include "engine/measure/approach.h"
#include "engine/measure/definitions.h"
#include "engine/measure/phases.h"
#include "engine/simulate.h"

namespace engine {
namespace {

struct Pulse {
  std::vector<double> times, acceleration;
};

Pulse half_sine(double peak_g, double duration) {
  Pulse pulse;
  const int samples = 2000;
  for (int i = 0; i <= samples; ++i) {
    pulse.times.push_back(duration * i / samples);
    pulse.acceleration.push_back(peak_g * std::sin(std::numbers::pi * i / samples));
  }
  return pulse;
}

TEST(HeadInjury, HalfSinesHaveTheirTabulatedValues) {
  const Pulse short_pulse = half_sine(100, 0.010), long_pulse = half_sine(100, 0.020);
  // 2000 samples: windows end within 1/4000 of the optimum, where the criterion is flat; the trapezium rule errs by 1e-6
  EXPECT_NEAR(hic(short_pulse.times, short_pulse.acceleration, 0.015), 414.65, 0.01);
  EXPECT_NEAR(hic(long_pulse.times, long_pulse.acceleration, 0.015), 829.29, 0.02);
  EXPECT_NEAR(three_ms_clip(short_pulse.times, short_pulse.acceleration), 89.10, 0.005);
}

TEST(HeadInjury, RigidImpactsSayWhyTheyHaveNone) {
  Model model;
  EXPECT_NE(why_no_head_injury(model), "");
  model.settings.contact_law = ContactLaw::compliant;
  EXPECT_EQ(why_no_head_injury(model), "");
}

// Runs made by hand: every figure below can be read off the numbers written into them.

constexpr int kHead = 0, kHips = 1, kCar = 2;
constexpr double kAlmost = 1e-12;  // sums and roots of a few numbers of order one

std::shared_ptr<const TriangleMesh> box(const Vec3& lower, const Vec3& upper) {
  std::vector<Vec3> v;
  for (int i = 0; i < 8; ++i)
    v.push_back({i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(), i & 4 ? upper.z() : lower.z()});
  return std::make_shared<TriangleMesh>(v, std::vector<Triangle>{{0, 2, 1},
                                                                 {1, 2, 3},
                                                                 {4, 5, 6},
                                                                 {5, 7, 6},
                                                                 {0, 1, 4},
                                                                 {1, 5, 4},
                                                                 {2, 6, 3},
                                                                 {3, 6, 7},
                                                                 {0, 4, 2},
                                                                 {2, 4, 6},
                                                                 {1, 3, 5},
                                                                 {3, 7, 5}});
}

/// A person of two bodies and a car: a box 4 m long and 1.6 m wide from 0.3 m to 1.0 m above the ground, origin 0.5 m above it.
Model person_and_car() {
  Model model;
  model.bodies.resize(3);
  for (const int b : {kHead, kHips}) {
    model.bodies[b].person = 0;
    model.bodies[b].shape = HyperEllipsoid{};
  }
  model.bodies[kHead].mass = 10;
  model.bodies[kHips].mass = 30;
  model.bodies[kCar].mass = 1000;
  model.bodies[kCar].vehicle = 0;
  model.bodies[kCar].shape = MeshShape{box({-2, -0.8, -0.2}, {2, 0.8, 0.5}), Pose{}};
  Person person;
  person.name = "pedestrian";
  person.bodies = {kHips, kHead};
  person.head = kHead;
  model.persons.push_back(person);
  Vehicle car;
  car.name = "car";
  car.body = kCar;
  Wheel wheel;
  wheel.hub_B = {1.2, 0.7, -0.2};
  wheel.radius = 0.3;
  car.wheels = {wheel};
  model.vehicles.push_back(car);
  return model;
}

Snapshot still(double time) {
  Snapshot s;
  s.time = time;
  s.bodies.resize(3);
  s.bodies[kCar].X_WB.p = {0, 0, 0.5};
  return s;
}

std::optional<double> value_of(const std::vector<Metric>& metrics, const std::string& key) {
  for (const Metric& m : metrics)
    if (m.key == key) return m.value;
  return std::nullopt;
}

ContactRecord push(int a, int b, ContactKind kind, const Vec3& impulse) {
  ContactRecord c;
  c.kind = kind;
  c.body_a = a;
  c.body_b = b;
  c.impulse = impulse;
  c.normal_impulse = impulse.norm();
  return c;
}

/// The car heads along +y at 5 m/s; the person, struck at 1 s, is as fast at 2 s, let go at 3 s, down at 4 s, bounces until 5 s and
/// lies from 6 s on. Head and hips move apart, their centre of mass (10 : 30 kg) counts.
Recording struck_along_y() {
  Recording run;
  run.interval = 1;
  const Quat heading(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));
  const double y[] = {0, 0, 3, 7, 12, 14, 16}, speed[] = {0, 0, 6, 6, 5, 2, 0};
  for (int i = 0; i < 7; ++i) {
    Snapshot s = still(i);
    s.bodies[kCar].X_WB.q = heading;
    s.bodies[kCar].V_WB.v = {0, 5, 0};
    s.bodies[kHead].X_WB.p = {1.0 * i, y[i], 1};
    s.bodies[kHips].X_WB.p = {0, y[i], 1};
    for (const int b : {kHead, kHips}) s.bodies[b].V_WB.v = {0, speed[i], 0};
    run.snapshots.push_back(s);
  }
  for (const int i : {1, 2, 3}) run.snapshots[i].contacts.push_back(push(kHips, kCar, ContactKind::vehicle, {0, 10, 0}));
  run.events = {{1, "first_contact", kHips, kCar, Vec3::Zero(), 0},
                {4, "ground_contact", kHips, -1, Vec3::Zero(), 0},
                {6, "rest", kHips, -1, Vec3::Zero(), 0}};
  // a bounce: on the ground at 4 s, off it, on it again at 5 s and from there on without a break a row could see
  run.snapshots[4].contacts.push_back(push(kHips, -1, ContactKind::ground, {0, 0, 9}));
  run.snapshots[5].contacts.push_back(push(kHips, -1, ContactKind::ground, {0, 0, 9}));
  return run;
}

TEST(ThrowMetrics, DistancesAreThoseOfTheCentreOfMass) {
  const Model model = person_and_car();
  std::vector<Metric> out;
  measure_throw(model, struck_along_y(), 0, out);
  // centre of mass: (0.25, 0) when struck, (1.5, 16) at rest
  EXPECT_NEAR(value_of(out, "throw_distance_m").value(), std::hypot(1.25, 16), kAlmost);
  EXPECT_NEAR(value_of(out, "throw_along_m").value(), 16, kAlmost);
  EXPECT_NEAR(value_of(out, "throw_across_m").value(), -1.25, kAlmost);
  EXPECT_EQ(value_of(out, "rest_s"), 6.0);
  EXPECT_EQ(value_of(out, "landing_s"), 4.0);
  EXPECT_EQ(value_of(out, "first_ground_contact_s"), value_of(out, "landing_s")) << "one value for one thing";
}

TEST(ThrowMetrics, PhasesFollowEachOtherAndAddUpToTheThrow) {
  const Model model = person_and_car();
  const auto thrown = throw_of_person(model, struck_along_y(), 0);
  ASSERT_TRUE(thrown);
  const std::vector<std::pair<std::string, double>> expected{{"contact", 1}, {"carried", 2}, {"flight", 3},
                                                             {"landing", 4}, {"slide", 5},   {"rest", 6}};
  ASSERT_EQ(thrown->phases.size(), expected.size());
  double sum = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(thrown->phases[i].name, expected[i].first);
    EXPECT_NEAR(thrown->phases[i].from, expected[i].second, kAlmost) << expected[i].first;
    if (i > 0) {
      EXPECT_EQ(thrown->phases[i].from, thrown->phases[i - 1].to);
    }
    sum += thrown->phases[i].distance;
  }
  EXPECT_NEAR(sum, thrown->thrown.norm(), kAlmost);
  // (0.25, 5) m of the flight along (1.25, 16)
  EXPECT_NEAR(thrown->phases[2].distance, (0.25 * 1.25 + 5 * 16) / std::hypot(1.25, 16), kAlmost);
}

TEST(ThrowMetrics, AFootOnTheGroundIsNoLandingAndAWalkNoFlight) {
  const Model model = person_and_car();
  Recording run = struck_along_y();
  std::erase_if(run.events, [](const Event& e) { return e.kind == "ground_contact"; });
  std::vector<Metric> out;
  measure_throw(model, run, 0, out);
  EXPECT_FALSE(value_of(out, "landing_s"));
  EXPECT_FALSE(value_of(out, "airborne_m"));
  EXPECT_FALSE(value_of(out, "slide_m"));
  // down while the car still pushes: no flight, whatever was on the ground before
  run.events.push_back({3, "ground_contact", kHips, -1, Vec3::Zero(), 0});
  out.clear();
  measure_throw(model, run, 0, out);
  EXPECT_EQ(value_of(out, "landing_s"), 3.0);
  EXPECT_FALSE(value_of(out, "airborne_m"));
  EXPECT_TRUE(value_of(out, "slide_m"));
}

TEST(ThrowMetrics, RiderAndMountHaveEachTheirOwnRestAndThrow) {
  Model model = person_and_car();
  model.bodies.emplace_back();  // a mount, which has its rider's number
  model.bodies[3].name = "bicycle";
  model.bodies[3].person = 0;
  model.bodies[3].vehicle = 1;
  model.bodies[3].mass = 15;
  Vehicle bicycle;
  bicycle.name = "bicycle";
  bicycle.body = 3;
  model.vehicles.push_back(bicycle);
  model.persons[0].mount = 3;
  Recording run = struck_along_y();
  for (std::size_t i = 0; i < run.snapshots.size(); ++i) {
    run.snapshots[i].bodies.emplace_back();
    run.snapshots[i].bodies[3].X_WB.p = {0, std::min(4.0, 1.0 * static_cast<double>(i)), 0.5};
  }
  ContactRecord hit = push(kCar, 3, ContactKind::vehicle_pair, {0, -5, 0});
  hit.begun = 0.5;  // the mount is struck before the rider
  run.snapshots[1].contacts.push_back(hit);
  run.events.push_back({2, "rest", 3, -1, Vec3::Zero(), 0});
  std::vector<Metric> out;
  measure_throw(model, run, 0, out);
  const auto of = [&](const char* key, const std::string& object) {
    for (const Metric& m : out)
      if (m.key == key && m.object == object) return m.value;
    return std::nan("");
  };
  EXPECT_EQ(of("rest_s", "pedestrian"), 6.0);
  EXPECT_EQ(of("rest_s", "bicycle"), 2.0);
  EXPECT_NEAR(of("throw_distance_m", "bicycle"), 1.5, kAlmost) << "from the touch at 0.5 s to its own rest";
  // the rider's centre was at (0.125, 0) when the mount was struck
  EXPECT_NEAR(of("throw_distance_m", "pedestrian"), std::hypot(1.375, 16), kAlmost);
}

TEST(BodyMetrics, ReboundIsTheTopOfTheFlightBetweenTwoTouches) {
  Model model;
  model.bodies.resize(1);
  model.bodies[0].name = "ball";
  HyperEllipsoid ball;
  model.bodies[0].shape = ball;
  const double radius = aabb_half_widths(ball, Quat::Identity()).z();
  Recording run;
  // off the ground at 0.1 s with 2 m/s; the top, 2^2/(2 g) above, lies between two recorded instants
  for (int i = 0; i < 7; ++i) {
    Snapshot s;
    s.time = 0.1 * i;
    s.bodies.resize(1);
    const double t = s.time - 0.1;
    s.bodies[0].X_WB.p = {3.0 * i, 4.0 * i, radius + (i ? 2 * t - 0.5 * 9.81 * t * t : 0.3)};
    s.bodies[0].V_WB.v = {30, 40, i ? 2 - 9.81 * t : -3};
    run.snapshots.push_back(s);
  }
  for (const int i : {1, 6}) run.snapshots[i].contacts.push_back(push(0, -1, ContactKind::ground, {0, 0, 5}));
  std::vector<Metric> out;
  measure_body(model, run, 0, out);
  // the top is a flat maximum: searched to 1e-9 s it is right to rounding
  EXPECT_NEAR(value_of(out, "rebound_height_m").value(), 2.0 * 2.0 / (2 * 9.81), kAlmost);
  EXPECT_NEAR(value_of(out, "travel_m").value(), 30, kAlmost);
  EXPECT_NEAR(value_of(out, "turned_deg").value(), 0, 1e-6);
}

TEST(VehicleMetrics, DeltaVIsTheChangeOfVelocityOfTheCollisionAndNotOfTheRun) {
  Model model = person_and_car();
  model.settings.gravity.setZero();
  Recording run;
  run.interval = 0.01;
  for (int i = 0; i < 60; ++i) run.snapshots.push_back(still(0.01 * i));
  // the car heads along +y when it is struck and turns afterwards, which must not matter
  const Vec3 after(-3, -3, 0);
  for (int i = 0; i < 60; ++i) {
    Snapshot& s = run.snapshots[i];
    if (i < 5) s.bodies[kCar].X_WB.q = Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));
    s.bodies[kCar].V_WB.v = i < 5 ? Vec3(0, 20, 0) : Vec3(Vec3(0, 20, 0) + after);
    s.tyre_impulse = {Vec3::Zero()};
  }
  // it brakes with 100 N s meanwhile, which is no collision
  run.snapshots[5].tyre_impulse = {Vec3(0, -100, 0)};
  for (Snapshot& s : run.snapshots)
    if (s.time > 0.045) s.bodies[kCar].V_WB.v.y() -= 0.1;
  run.snapshots[5].contacts = {push(kHips, kCar, ContactKind::vehicle, {3000, 3000, 0}),
                               push(kCar, -1, ContactKind::ground, {0, 0, 1e6})};
  // and drags on for half a second, pressed and held: that adds nothing
  for (int i = 6; i < 60; ++i) run.snapshots[i].contacts = {push(kHips, kCar, ContactKind::vehicle, {2, 0, 0})};
  std::vector<Metric> out;
  measure_vehicle(model, run, impacts_of(model, run), 0, out);
  EXPECT_NEAR(value_of(out, "delta_v_mps").value(), 3 * std::sqrt(2.0), 1e-9);
  // pushed backwards and to the left: from the right front
  EXPECT_NEAR(value_of(out, "pdof_deg").value(), 45, 1e-9);
  EXPECT_FALSE(value_of(out, "ees_mps")) << "a person takes up no energy that would deform a car";
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
    run.snapshots.back().bodies[kCar].X_WB = {Vec3(3.0 * i, 4.0 * i, 0.5),
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
std::vector<Impact> car_against_block(double mass, double energy, double stiffness = 400e3, bool fixed = false) {
  Model model = person_and_car();
  Body& block = model.bodies[kHips];
  block.person = -1;
  block.mass = mass;
  block.fixed = fixed;
  block.surface.stiffness = stiffness;
  block.shape = model.bodies[kCar].shape;
  Recording run;
  run.interval = 0.01;
  for (int i = 0; i < 20; ++i) {
    run.snapshots.push_back(still(0.01 * i));
    run.snapshots.back().bodies[kCar].V_WB.v = {i < 5 ? 10.0 : 4.0, 0, 0};
  }
  ContactRecord c = push(kCar, kHips, ContactKind::vehicle_pair, {-6000, 0, 0});
  c.normal = {-1, 0, 0};
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

/// A car at 12 m/s strikes a falling head at 0.2 s, on the top of the box 1.5 m behind its front and 0.4 m beside the middle.
Recording head_on_bonnet() {
  Recording run;
  run.interval = 0.1;
  for (int i = 0; i < 4; ++i) {
    Snapshot s = still(0.1 * i);
    s.bodies[kCar].X_WB.p.x() = 1.2 * i;
    s.bodies[kCar].V_WB.v = {12, 0, 0};
    s.bodies[kHead].X_WB.p = {2.9, 0.4, 1.1};
    s.bodies[kHead].V_WB.v = i < 2 ? Vec3(3, 0, -5) : Vec3(12, 0, 1);
    s.bodies[kHead].V_WB.w = {0, 40, 0};  // the centre of the head counts, not its surface
    run.snapshots.push_back(s);
  }
  run.events = {{run.snapshots[2].time, "head_impact", kHead, kCar, {2.9, 0.4, 1.0}, std::hypot(9, 5), {0, 0, 1}, {-9, 0, -5}}};
  return run;
}

TEST(HeadMetrics, SpeedIsThatOfTheEventWithItsPartsAndPlace) {
  const Model model = person_and_car();
  std::vector<Metric> out;
  measure_head(model, head_on_bonnet(), 0, out);
  EXPECT_NEAR(value_of(out, "head_impact_s").value(), 0.2, kAlmost);
  EXPECT_NEAR(value_of(out, "head_impact_speed_mps").value(), std::hypot(9, 5), kAlmost);
  EXPECT_NEAR(value_of(out, "head_impact_normal_mps").value(), 5, kAlmost);
  EXPECT_NEAR(value_of(out, "head_impact_tangential_mps").value(), 9, kAlmost);
  // the car stands at (2.4, 0, 0.5) then
  EXPECT_NEAR(value_of(out, "head_impact_vehicle_x_m").value(), 0.5, kAlmost);
  EXPECT_NEAR(value_of(out, "head_impact_vehicle_y_m").value(), 0.4, kAlmost);
  EXPECT_NEAR(value_of(out, "head_impact_vehicle_z_m").value(), 0.5, kAlmost);
}

TEST(HeadMetrics, RecorderTakesTheCentreOfTheHeadAgainstTheTurningSurface) {
  Model model = person_and_car();
  model.ground.plane = false;
  model.vehicles[0].wheels.clear();
  model.settings.gravity.setZero();
  model.settings.duration = 0.1;
  HyperEllipsoid ball;
  ball.semi_axes = {0.1, 0.1, 0.1};
  ball.exponent = 2;
  for (const int b : {kHead, kHips}) model.bodies[b].shape = ball;
  model.bodies[kHips].X_WB.p = {0, 0, 20};
  model.bodies[kHead].X_WB.p = {1.0, 0.4, 0.7};  // 0.1 m over the box, comes down on it at (1, 0.4) but for what 20 ms move it
  model.bodies[kHead].V_WB = {Vec3(3, 0, -5), Vec3(0, 40, 0)};
  model.bodies[kCar].mass = 1e6;
  model.bodies[kCar].inertia_B = 1e6 * Mat3::Identity();
  model.bodies[kCar].V_WB.w = {0, 0, 2};
  model.persons[0].zero_condition = false;
  const Recording run = simulate(model);
  std::vector<Metric> out;
  measure_head(model, run, 0, out);
  // surface at arm (1.06, 0.4): (-0.8, 2.1); a step before the touch is the touch, nothing accelerates
  EXPECT_NEAR(value_of(out, "head_impact_speed_mps").value(), Vec3(3.8, -2.1, -5).norm(), 0.1);
  for (const Event& e : run.events)
    if (e.kind == "head_impact") {
      EXPECT_EQ(e.value, value_of(out, "head_impact_speed_mps")) << "event and measure are one value";
    }
}

TEST(HeadMetrics, WrapAroundOfABoxIsHeightPlusLength) {
  const Model model = person_and_car();
  std::vector<Metric> out;
  measure_head(model, head_on_bonnet(), 0, out);
  // foremost part 2.0 m before the origin, head 0.5 m before it; the top is 1.0 m above the ground
  EXPECT_NEAR(value_of(out, "wrap_around_distance_m").value(), 1.0 + 1.5, kAlmost);
}

TEST(HeadMetrics, WrapAroundIsAbsentWhenTheVehicleReversesOrIsMetFromTheSide) {
  const Model model = person_and_car();
  for (const Vec3& velocity : {Vec3(15, 0, -5), Vec3(-4, 10, -3)}) {
    Recording run = head_on_bonnet();
    run.events[0].velocity = velocity;
    std::vector<Metric> out;
    measure_head(model, run, 0, out);
    EXPECT_TRUE(value_of(out, "head_impact_speed_mps"));
    EXPECT_FALSE(value_of(out, "wrap_around_distance_m"));
  }
}

TEST(HeadMetrics, TapeBridgesHollowsAndStartsBeforeTheForemostPart) {
  Model model = person_and_car();
  // from the side: foot (2.0, -0.2), edge (1.6, 0.3), hollow (0.8, 0.2), screen (0, 0.9), down to the rear; 1 m either side
  const std::vector<Vec3> side{{2, 0, -0.2}, {1.6, 0, 0.3}, {0.8, 0, 0.2}, {0, 0, 0.9}, {-2, 0, -0.2}};
  std::vector<Vec3> v;
  std::vector<Triangle> t;
  for (const Vec3& p : side)
    for (const double y : {-1.0, 1.0}) v.push_back(p + y * Vec3::UnitY());
  for (int i = 0; i < 4; ++i) {
    t.push_back({2 * i, 2 * i + 1, 2 * i + 2});
    t.push_back({2 * i + 1, 2 * i + 3, 2 * i + 2});
  }
  model.bodies[kCar].shape = MeshShape{std::make_shared<TriangleMesh>(v, t), Pose{}};
  const auto tape = wrap_around_distance(model, kCar, {0, 0, 0.9});
  ASSERT_TRUE(tape);
  // ground 0.5 m below the origin: up 0.3 m to the foot, straight to the edge, straight over the hollow to the screen's top
  EXPECT_NEAR(*tape, 0.3 + std::hypot(0.4, 0.5) + std::hypot(1.6, 0.6), kAlmost);
  model.bodies[kCar].vehicle = -1;
  EXPECT_FALSE(wrap_around_distance(model, kCar, {0, 0, 0.9}));
}

TEST(HeadMetrics, TapeGoesOverNothingThatLiesAboveTheHead) {
  Model model = person_and_car();
  // a flat front 2.5 m high with a mirror half a metre before it and above
  model.bodies[kCar].shape = MeshShape{box({-2, -0.8, -0.2}, {2, 0.8, 2.0}), Pose{}};
  const auto plain = wrap_around_distance(model, kCar, {2, 0, 0.5});
  ASSERT_TRUE(plain);
  EXPECT_NEAR(*plain, 1.0, kAlmost) << "straight up a flat front: the height of the head";
  EXPECT_FALSE(wrap_around_distance(model, kCar, {0, 0, -0.19})) << "no tape reaches the underside";
  std::vector<Vec3> v{{-2, -0.8, -0.2}, {-2, 0.8, -0.2}, {2, -0.8, -0.2},  {2, 0.8, -0.2},
                      {2, -0.8, 2.0},   {2, 0.8, 2.0},   {2.5, -0.8, 1.5}, {2.5, 0.8, 1.5}};
  model.bodies[kCar].shape = MeshShape{
      std::make_shared<TriangleMesh>(v, std::vector<Triangle>{{2, 3, 4}, {3, 5, 4}, {4, 6, 5}, {5, 6, 7}, {0, 2, 1}, {1, 2, 3}}),
      Pose{}};
  const auto under_mirror = wrap_around_distance(model, kCar, {2, 0, 0.5});
  ASSERT_TRUE(under_mirror);
  EXPECT_NEAR(*under_mirror, 1.0, kAlmost);
}

TEST(HeadMetrics, CriteriaAreToldApartByPartner) {
  Model model = person_and_car();
  model.settings.contact_law = ContactLaw::compliant;
  Recording run;
  run.interval = 0.005;
  HeadMotion head{0, {}, {}};
  for (int i = 0; i <= 200; ++i) {
    Snapshot s = still(0.005 * i);
    if (i >= 41 && i <= 44) s.contacts = {push(kHead, kCar, ContactKind::vehicle, {0, 0, 1})};
    if (i >= 121 && i <= 122) s.contacts = {push(kHead, -1, ContactKind::ground, {0, 0, 1})};
    run.snapshots.push_back(s);
  }
  const auto pulse = [](double t, double from, double peak_g, double lasts) {
    return t > from && t < from + lasts ? peak_g * kGravity * std::sin(std::numbers::pi * (t - from) / lasts) : 0;
  };
  for (int i = 0; i <= 10000; ++i) {
    const double t = 1e-4 * i;
    head.time.push_back(t);
    head.acceleration.push_back(pulse(t, 0.2, 100, 0.02) + pulse(t, 0.6, 100, 0.01));
  }
  run.heads = {head};
  std::vector<Metric> out;
  measure_injury(model, run, 0, out);
  // the half sines of HalfSinesHaveTheirTabulatedValues, at 100 to 200 samples each
  EXPECT_NEAR(value_of(out, "hic15_vehicle").value(), 829.3, 1);
  EXPECT_NEAR(value_of(out, "hic15_ground").value(), 414.6, 1);
  EXPECT_EQ(value_of(out, "hic15"), value_of(out, "hic15_vehicle"));
  run.snapshots[41].contacts.clear();
  for (Snapshot& s : run.snapshots)
    std::erase_if(s.contacts, [](const ContactRecord& c) { return c.kind == ContactKind::vehicle; });
  out.clear();
  measure_injury(model, run, 0, out);
  EXPECT_FALSE(value_of(out, "hic15_vehicle"));
  EXPECT_TRUE(value_of(out, "hic15")) << "a head that meets only the road has a criterion too";
}

TEST(NearestApproach, ARunWithoutATouchSaysHowNearItWas) {
  Model model = person_and_car();
  HyperEllipsoid ball;
  ball.semi_axes = {0.1, 0.1, 0.1};
  ball.exponent = 2;
  for (const int b : {kHead, kHips}) model.bodies[b].shape = ball;
  Recording run;
  run.interval = 0.1;
  for (int i = 0; i < 11; ++i) {
    Snapshot s = still(0.1 * i);
    s.bodies[kCar].X_WB.p = {1.0 * i, 0, 0.5};
    s.bodies[kHead].X_WB.p = {7, 1.4, 0.6};
    s.bodies[kHips].X_WB.p = {7, 3, 0.6};
    run.snapshots.push_back(s);
  }
  const auto near = nearest_approach(model, run);
  ASSERT_TRUE(near);
  EXPECT_NEAR(near->distance, 1.4 - 0.8 - 0.1, 1e-9);
  EXPECT_EQ(near->body_a, kHead);
  run.snapshots[3].contacts = {push(kHips, kCar, ContactKind::vehicle, {1, 0, 0})};
  EXPECT_FALSE(nearest_approach(model, run)) << "they touched";
}

TEST(Definitions, EveryMeasureIsDefinedOnceWithItsUnitInItsName) {
  std::set<std::string> keys;
  for (const Definition& d : definitions()) {
    EXPECT_TRUE(keys.insert(d.key).second) << d.key;
    for (const char* text : {d.title, d.definition, d.absent, d.sureness}) EXPECT_GT(std::string(text).size(), 0u) << d.key;
    const std::map<std::string, std::string> endings{{"m", "_m"}, {"s", "_s"}, {"m/s", "_mps"}, {"deg", "_deg"}, {"g", "_g"}};
    if (const auto ending = endings.find(d.unit); ending != endings.end()) {
      EXPECT_TRUE(std::string(d.key).ends_with(ending->second)) << d.key;
    }
  }
  const Model model = person_and_car();
  for (const Recording& run : {struck_along_y(), head_on_bonnet()}) {
    const std::vector<Metric> metrics = measure(model, run);
    for (const Metric& m : metrics) EXPECT_TRUE(definition_of(m.key)) << m.key;
    for (const AbsentMetric& a : absent_metrics(model, run, metrics)) {
      EXPECT_TRUE(definition_of(a.key)) << a.key;
      EXPECT_TRUE(
          std::none_of(metrics.begin(), metrics.end(), [&](const Metric& m) { return m.key == a.key && m.object == a.object; }))
          << a.key << ": either a figure or a reason";
    }
  }
}

TEST(HeadMetrics, StruckHeadSaysWhyItHasNoCriterion) {
  Model model = person_and_car();
  Recording run = head_on_bonnet();
  const auto reason_of = [&](const std::string& key) {
    for (const AbsentMetric& a : absent_metrics(model, run, measure(model, run)))
      if (a.key == key && a.object == "pedestrian") return a.reason;
    return std::string();
  };
  for (const char* key : {"hic15", "hic36", "three_ms_g", "peak_acceleration_mps2"})
    EXPECT_EQ(reason_of(key), why_no_head_injury(model)) << key;
  EXPECT_EQ(reason_of("head_impact_s"), "");
  run.events.clear();
  EXPECT_NE(reason_of("head_impact_s"), "");
}

}  // namespace
}  // namespace engine
