#include "engine/measure/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

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

TEST(ThrowMetrics, DistancesAreThoseOfTheCentreOfMass) {
  const Model model = person_and_car();
  Recording run;
  run.interval = 1;
  // the car heads along +y; head and hips move apart, their centre of mass (10 : 30 kg) counts
  const Quat heading(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));
  const double head_x[] = {0, 0, 4, 8, 8}, hips_y[] = {0, 0, 4, 8, 12};
  for (int i = 0; i < 5; ++i) {
    Snapshot s = still(i);
    s.bodies[kCar].X_WB.q = heading;
    s.bodies[kHead].X_WB.p = {head_x[i], 0, 1};
    s.bodies[kHips].X_WB.p = {0, hips_y[i], 1};
    run.snapshots.push_back(s);
  }
  run.snapshots[2].contacts.push_back(push(kHips, kCar, ContactKind::vehicle, {0, 10, 0}));
  run.events = {{1, "first_contact", kHips, kCar, Vec3::Zero(), 0},
                {3, "ground_contact", kHips, -1, Vec3::Zero(), 0},
                {4, "rest", kHips, -1, Vec3::Zero(), 0}};
  std::vector<Metric> out;
  measure_throw(model, run, 0, out);
  // centre of mass: (0, 0) at the hit, (1, 3) when the car lets go, (2, 6) on the ground, (2, 9) at rest
  EXPECT_NEAR(value_of(out, "throw_distance_m").value(), std::hypot(2, 9), kAlmost);
  EXPECT_NEAR(value_of(out, "throw_along_m").value(), 9, kAlmost);
  EXPECT_NEAR(value_of(out, "throw_across_m").value(), -2, kAlmost);
  EXPECT_NEAR(value_of(out, "airborne_m").value(), std::hypot(1, 3), kAlmost);
  EXPECT_NEAR(value_of(out, "slide_m").value(), 3, kAlmost);
  EXPECT_EQ(value_of(out, "rest_s"), 4.0);
  EXPECT_EQ(value_of(out, "first_ground_contact_s"), 3.0);
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

TEST(VehicleMetrics, ImpulsesAddAsVectorsInTheAxesOfTheFirstContact) {
  const Model model = person_and_car();
  Recording run;
  for (int i = 0; i < 3; ++i) run.snapshots.push_back(still(0.1 * i));
  // the car heads along +y when it is struck and turns afterwards, which must not matter
  run.snapshots[0].bodies[kCar].X_WB.q = Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));
  run.snapshots[1].contacts = {push(kHips, kCar, ContactKind::vehicle, {0, 3000, 4000}),
                               push(kCar, -1, ContactKind::ground, {0, 0, 1e6})};
  run.snapshots[2].contacts = {push(kHips, kCar, ContactKind::vehicle, {3000, 0, -4000})};
  std::vector<Metric> out;
  measure_vehicle(model, run, 0, out);
  // on the car: (-3000, -3000, 0) N s, though the magnitudes add to 10000
  EXPECT_NEAR(value_of(out, "delta_v_mps").value(), 3 * std::sqrt(2.0), kAlmost);
  // pushed backwards and to the left: from the right front
  EXPECT_NEAR(value_of(out, "pdof_deg").value(), 45, 1e-9);
  EXPECT_FALSE(value_of(out, "ees_mps"));
}

TEST(VehicleMetrics, UntouchedVehicleHasNone) {
  const Model model = person_and_car();
  Recording run;
  run.snapshots = {still(0), still(1)};
  std::vector<Metric> out;
  measure_vehicle(model, run, 0, out);
  EXPECT_TRUE(out.empty());
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
  run.events = {{run.snapshots[2].time, "head_impact", kHead, kCar, {2.9, 0.4, 1.0}, 5}};
  return run;
}

TEST(HeadMetrics, SpeedIsThatOfTheCentreBeforeTheExchange) {
  const Model model = person_and_car();
  std::vector<Metric> out;
  measure_head(model, head_on_bonnet(), 0, out);
  EXPECT_NEAR(value_of(out, "head_impact_s").value(), 0.2, kAlmost);
  EXPECT_NEAR(value_of(out, "head_impact_speed_mps").value(), std::hypot(9, 5), kAlmost);
}

TEST(HeadMetrics, TurningVehicleCarriesItsSurface) {
  const Model model = person_and_car();
  Recording run = head_on_bonnet();
  run.snapshots[1].bodies[kCar].V_WB.w = {0, 0, 2};  // at arm (0.5, 0.4): surface at (12 - 0.8, 1.0, 0)
  std::vector<Metric> out;
  measure_head(model, run, 0, out);
  EXPECT_NEAR(value_of(out, "head_impact_speed_mps").value(), Vec3(-8.2, -1, -5).norm(), kAlmost);
}

TEST(HeadMetrics, WrapAroundOfABoxIsHeightPlusLength) {
  const Model model = person_and_car();
  std::vector<Metric> out;
  measure_head(model, head_on_bonnet(), 0, out);
  // foremost part 2.0 m before the origin, head 0.5 m before it; the top is 1.0 m above the ground
  EXPECT_NEAR(value_of(out, "wrap_around_distance_m").value(), 1.0 + 1.5, kAlmost);
}

TEST(HeadMetrics, WrapAroundIsAbsentWhenTheVehicleReverses) {
  const Model model = person_and_car();
  Recording run = head_on_bonnet();
  for (Snapshot& s : run.snapshots) s.bodies[kCar].V_WB.v.x() = -12;
  std::vector<Metric> out;
  measure_head(model, run, 0, out);
  EXPECT_TRUE(value_of(out, "head_impact_speed_mps"));
  EXPECT_FALSE(value_of(out, "wrap_around_distance_m"));
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

TEST(HeadMetrics, StruckHeadSaysWhyItHasNoCriterion) {
  Model model = person_and_car();
  Recording run = head_on_bonnet();
  const auto absent = absent_metrics(model, run);
  ASSERT_EQ(absent.size(), 4u);
  EXPECT_EQ(absent[0].key, "hic15");
  EXPECT_EQ(absent[0].object, "pedestrian");
  EXPECT_EQ(absent[0].reason, why_no_head_injury(model));
  EXPECT_EQ(absent[3].key, "peak_acceleration_mps2");
  run.events.clear();
  EXPECT_TRUE(absent_metrics(model, run).empty());
}

}  // namespace
}  // namespace engine
