// Runs made by hand of a person and a car: every figure a test asks for can be read off the numbers written into them.
#pragma once

#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "engine/measure/metrics.h"
#include "engine/simulate.h"

namespace engine {

constexpr int kHead = 0, kHips = 1, kCar = 2;
constexpr double kAlmost = 1e-12;  // sums and roots of a few numbers of order one

inline std::shared_ptr<const TriangleMesh> box(const Vec3& lower, const Vec3& upper) {
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
inline Model person_and_car() {
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

inline Snapshot still(double time) {
  Snapshot s;
  s.time = time;
  s.bodies.own().resize(3);
  s.bodies.own()[kCar].X_WB.p = {0, 0, 0.5};
  return s;
}

/// So many snapshots at intervals of 0.01 s.
inline Recording standing_still(int instants) {
  Recording run;
  run.interval = 0.01;
  for (int i = 0; i < instants; ++i) run.snapshots.push_back(still(0.01 * i));
  return run;
}

inline std::optional<double> value_of(const std::vector<Metric>& metrics, const std::string& key) {
  for (const Metric& m : metrics)
    if (m.key == key) return m.value;
  return std::nullopt;
}

inline std::string text_of(const std::vector<Metric>& metrics, const std::string& key) {
  for (const Metric& m : metrics)
    if (m.key == key) return m.text;
  return "";
}

constexpr ShapePair kOnGround{}, kOnVehicle{ShapeKind::round, ShapeKind::mesh}, kVehicles{ShapeKind::mesh, ShapeKind::mesh};

inline ContactRecord push(int a, int b, const ShapePair& shapes, const Vec3& impulse) {
  ContactRecord c;
  c.shapes = shapes;
  c.body_a = a;
  c.body_b = b;
  c.impulse = impulse;
  c.normal_impulse = impulse.norm();
  return c;
}

/// The car heads along +y at 5 m/s; the person, struck at 1 s, is as fast at 2 s, let go at 3 s, down at 4 s, bounces until 5 s and
/// lies from 6 s on. Head and hips move apart, their centre of mass (10 : 30 kg) counts.
inline Recording struck_along_y() {
  Recording run;
  run.interval = 1;
  const Quat heading(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));
  const double y[] = {0, 0, 3, 7, 12, 14, 16}, speed[] = {0, 0, 6, 6, 5, 2, 0};
  for (int i = 0; i < 7; ++i) {
    Snapshot s = still(i);
    s.bodies.own()[kCar].X_WB.q = heading;
    s.bodies.own()[kCar].V_WB.v = {0, 5, 0};
    s.bodies.own()[kHead].X_WB.p = {1.0 * i, y[i], 1};
    s.bodies.own()[kHips].X_WB.p = {0, y[i], 1};
    for (const int b : {kHead, kHips}) s.bodies.own()[b].V_WB.v = {0, speed[i], 0};
    run.snapshots.push_back(s);
  }
  for (const int i : {1, 2, 3}) run.snapshots[i].contacts.push_back(push(kHips, kCar, kOnVehicle, {0, 10, 0}));
  run.events = {{1, "first_contact", kHips, kCar, Vec3::Zero(), 0},
                {4, "ground_contact", kHips, -1, Vec3::Zero(), 0},
                {6, "rest", kHips, -1, Vec3::Zero(), 0}};
  // a bounce: on the ground at 4 s, off it, on it again at 5 s and from there on without a break a row could see
  run.snapshots[4].contacts.push_back(push(kHips, -1, kOnGround, {0, 0, 9}));
  run.snapshots[5].contacts.push_back(push(kHips, -1, kOnGround, {0, 0, 9}));
  return run;
}

/// A car at 12 m/s strikes a falling head at 0.2 s, on the top of the box 1.5 m behind its front and 0.4 m beside the middle.
inline Recording head_on_bonnet() {
  Recording run;
  run.interval = 0.1;
  for (int i = 0; i < 4; ++i) {
    Snapshot s = still(0.1 * i);
    s.bodies.own()[kCar].X_WB.p.x() = 1.2 * i;
    s.bodies.own()[kCar].V_WB.v = {12, 0, 0};
    s.bodies.own()[kHead].X_WB.p = {2.9, 0.4, 1.1};
    s.bodies.own()[kHead].V_WB.v = i < 2 ? Vec3(3, 0, -5) : Vec3(12, 0, 1);
    s.bodies.own()[kHead].V_WB.w = {0, 40, 0};  // the centre of the head counts, not its surface
    run.snapshots.push_back(s);
  }
  run.events = {{run.snapshots[2].time, "head_impact", kHead, kCar, {2.9, 0.4, 1.0}, std::hypot(9, 5), {0, 0, 1}, {-9, 0, -5}}};
  return run;
}

}  // namespace engine
