#include "tests/benchmark/common_scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/geometry/hyper_ellipsoid.h"

namespace benchmark {
namespace {

using engine::Body;
using engine::Joint;
using engine::JointKind;
using engine::Model;
using engine::Pose;
using engine::Quat;
using engine::Vec3;

constexpr double kExponent = 2.5;

struct Segment {
  const char* name;
  double mass, radius, half_length;  // [kg], [m] across, [m] along beyond the radius
  Vec3 at;
  int along;  // 0 x, 1 y, 2 z
};

/// Right and left of the body share one row: mirrored where y is not zero.
const Segment kTrunk[] = {{"pelvis", 11, 0.11, 0.08, {0, 0, 0.98}, 1},
                          {"abdomen", 9, 0.10, 0.06, {0, 0, 1.13}, 1},
                          {"thorax", 18, 0.15, 0.10, {0, 0, 1.33}, 1},
                          {"head", 5.2, 0.095, 0.04, {0, 0, 1.64}, 2}};
const Segment kLimb[] = {{"thigh", 8.5, 0.07, 0.14, {0, 0.1, 0.69}, 2},      {"shin", 3.5, 0.05, 0.14, {0, 0.1, 0.285}, 2},
                         {"foot", 1.1, 0.045, 0.07, {0.05, 0.1, 0.05}, 0},   {"upper_arm", 2.1, 0.045, 0.10, {0, 0.26, 1.28}, 2},
                         {"forearm", 1.4, 0.04, 0.085, {0, 0.26, 1.005}, 2}, {"hand", 0.5, 0.035, 0.04, {0, 0.26, 0.80}, 2}};

struct Link {
  int parent, child;
  Vec3 at;
  bool hinge = false;
  double lower = 0, upper = 0;
};

Body segment(const Segment& s, double side) {
  Body body;
  body.name = s.name + std::string(side < 0 ? "_right" : "");
  body.mass = s.mass;
  const double c = s.radius + s.half_length;
  const engine::HyperEllipsoid shape{{s.radius, s.radius, c}, kExponent};
  body.shape = shape;
  const double across = s.mass / 5 * (s.radius * s.radius + c * c);
  body.inertia_B = Vec3(across, across, s.mass / 5 * 2 * s.radius * s.radius).asDiagonal();
  body.X_WB.p = {s.at.x(), side * s.at.y(), s.at.z()};
  if (s.along == 0) body.X_WB.q = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY());
  if (s.along == 1) body.X_WB.q = Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX());
  body.surface.friction_body = body.surface.friction_ground = 0.6;
  return body;
}

/// The figure standing at the origin; joints hold where it stands.
void add_figure(Model& model, const Pose& X_WF) {
  const int first = static_cast<int>(model.bodies.size());
  for (const Segment& s : kTrunk) model.bodies.push_back(segment(s, 1));
  for (const double side : {1.0, -1.0})
    for (const Segment& s : kLimb) model.bodies.push_back(segment(s, side));
  std::vector<Link> links = {{0, 1, {0, 0, 1.06}}, {1, 2, {0, 0, 1.20}}, {2, 3, {0, 0, 1.50}}};
  for (int side = 0; side < 2; ++side) {
    const int limb = 4 + 6 * side;
    const double y = side ? -1 : 1;
    links.push_back({0, limb, {0, y * 0.1, 0.90}});
    links.push_back({limb, limb + 1, {0, y * 0.1, 0.48}, true, 0, 2.4});
    links.push_back({limb + 1, limb + 2, {0, y * 0.1, 0.09}});
    links.push_back({2, limb + 3, {0, y * 0.26, 1.43}});
    links.push_back({limb + 3, limb + 4, {0, y * 0.26, 1.13}, true, -2.4, 0});
    links.push_back({limb + 4, limb + 5, {0, y * 0.26, 0.88}});
  }
  for (const Link& link : links) {
    Joint joint;
    joint.name = model.bodies[first + link.child].name;
    joint.kind = link.hinge ? JointKind::revolute : JointKind::spherical;
    joint.parent = first + link.parent;
    joint.child = first + link.child;
    const Pose X_FJ{link.at, Quat::Identity()};
    joint.X_PF = model.bodies[joint.parent].X_WB.inverse() * X_FJ;
    joint.X_CF = model.bodies[joint.child].X_WB.inverse() * X_FJ;
    if (link.hinge) joint.angles[1].lower = link.lower, joint.angles[1].upper = link.upper;
    model.joints.push_back(joint);
  }
  engine::Person person;
  person.name = "figure" + std::to_string(model.persons.size());
  person.zero_condition = false;
  person.head = first + 3;
  for (int b = first; b < static_cast<int>(model.bodies.size()); ++b) {
    model.bodies[b].X_WB = X_WF * model.bodies[b].X_WB;
    model.bodies[b].person = static_cast<int>(model.persons.size());
    person.bodies.push_back(b);
  }
  model.persons.push_back(person);
}

double lowest_point(const Model& model, const std::vector<int>& bodies) {
  double lowest = 1e9;
  for (const int b : bodies) {
    const auto& shape = std::get<engine::HyperEllipsoid>(model.bodies[b].shape);
    const Pose& X = model.bodies[b].X_WB;
    lowest = std::min(lowest, X.p.z() - engine::support_value(shape, X.q.conjugate() * Vec3(0, 0, -1)));
  }
  return lowest;
}

void lift(Model& model, const std::vector<int>& bodies, const Vec3& by) {
  for (const int b : bodies) model.bodies[b].X_WB.p += by;
}

/// A spin of the whole with relative spins down the tree, such that all joints hold.
void set_flying(Model& model) {
  auto& bodies = model.bodies;
  bodies[0].V_WB = {{0, 0, 5}, {1, 2, 0.5}};
  for (int k = 0; k < static_cast<int>(model.joints.size()); ++k) {
    Joint& joint = model.joints[k];
    joint.angles[1] = {};
    const double a = 1 + 0.5 * (k % 4);
    const Vec3 spin =
        joint.kind == JointKind::revolute ? Vec3(0, a, 0) : Vec3((k % 2 ? 1 : -1) * a, (k % 3 - 1) * 1.5, ((k * 7) % 5 - 2) * 0.8);
    const Body& parent = bodies[joint.parent];
    Body& child = bodies[joint.child];
    const Vec3 at = (parent.X_WB * joint.X_PF).p;
    child.V_WB.w = parent.V_WB.w + spin;
    child.V_WB.v = parent.V_WB.v + parent.V_WB.w.cross(at - parent.X_WB.p) - child.V_WB.w.cross(at - child.X_WB.p);
  }
}

constexpr double kCarLength = 4.0, kCarWidth = 1.8, kCarHeight = 0.7;  // [m] of the comparison's car

std::shared_ptr<const engine::TriangleMesh> car_mesh(int triangles) {
  return box_mesh(0.5 * Vec3(kCarLength, kCarWidth, kCarHeight), triangles);
}

void add_car(Model& model, const std::shared_ptr<const engine::TriangleMesh>& mesh, const Vec3& at) {
  Body body;
  body.name = "car";
  body.mass = 1500;
  body.inertia_B = Vec3::Constant(1e60).asDiagonal();  // the comparison's car never turns, not by a last digit
  body.shape = engine::MeshShape{mesh, {}};
  body.X_WB.p = at;
  body.V_WB.v = {11, 0, 0};
  body.surface.friction_body = 0.6;
  body.vehicle = static_cast<int>(model.vehicles.size());
  engine::Vehicle vehicle;
  vehicle.name = "car";
  vehicle.body = static_cast<int>(model.bodies.size());
  for (const double x : {1.3, -1.3})
    for (const double y : {0.75, -0.75}) {
      engine::Wheel wheel;
      wheel.name = "wheel";
      wheel.hub_B = {x, y, 0.3 - at.z()};
      wheel.friction = 0.8;
      wheel.brake_share = 0.25;
      vehicle.wheels.push_back(wheel);
    }
  vehicle.brake = engine::Schedule({{0.0, 0.0}, {0.149, 0.0}, {0.15, 1.0}});
  vehicle.brake_force = 0.7 * 9.81 * body.mass;
  model.bodies.push_back(body);
  model.vehicles.push_back(vehicle);
}

Pose turned(double angle, const Vec3& axis, double heading, const Vec3& to) {
  return {to, Quat(Eigen::AngleAxisd(heading, Vec3::UnitZ())) * Quat(Eigen::AngleAxisd(angle, axis))};
}

Model empty(double duration, double step) {
  Model model;
  model.settings.duration = duration;
  model.settings.step = step;
  model.settings.record_interval = 20 * step;
  model.settings.stop_at_rest = false;
  model.settings.effects["air_drag"] = engine::Force::off;  // as in the other engines
  return model;
}

}  // namespace

std::shared_ptr<const engine::TriangleMesh> box_mesh(const Vec3& half, int triangles) {
  // cells of about equal size on all faces
  const double area = 8 * (half.x() * half.y() + half.y() * half.z() + half.z() * half.x());
  const double cell = std::sqrt(2 * area / triangles);
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const int nu = std::max(1, static_cast<int>(std::lround(2 * half[u] / cell)));
      const int nv = std::max(1, static_cast<int>(std::lround(2 * half[v] / cell)));
      const int base = static_cast<int>(points.size());
      for (int i = 0; i <= nu; ++i)
        for (int k = 0; k <= nv; ++k) {
          Vec3 p;
          p[axis] = side * half[axis];
          p[u] = half[u] * (2.0 * i / nu - 1);
          p[v] = half[v] * (2.0 * k / nv - 1);
          points.push_back(p);
        }
      for (int i = 0; i < nu; ++i)
        for (int k = 0; k < nv; ++k) {
          const int a = base + i * (nv + 1) + k, b = a + nv + 1, c = b + 1, d = a + 1;
          if (side > 0) {
            faces.push_back({a, b, c});
            faces.push_back({a, c, d});
          } else {
            faces.push_back({a, c, b});
            faces.push_back({a, d, c});
          }
        }
    }
  return std::make_shared<const engine::TriangleMesh>(std::move(points), std::move(faces));
}

Model common_scene(const std::string& name, double step, double shift) {
  const double deg = std::numbers::pi / 180;
  Model model = empty(name == "flight" ? 1.0 : 3.0, step);
  if (name == "flight") {
    add_figure(model, {});
    model.ground.plane = false;
    model.settings.effects["self_contact"] = engine::Force::off;
    set_flying(model);
    return model;
  }
  if (name == "vehicle") {
    add_figure(model, turned(0, Vec3::UnitX(), 90 * deg, {0, shift + 0.05, 0}));
    add_car(model, car_mesh(20000), {-2.6, 0, 0.6});
    return model;
  }
  const bool thrown = name == "throw";
  Pose X;
  X.q = thrown ? Quat(Eigen::AngleAxisd(0.3, Vec3::UnitZ())) * Quat(Eigen::AngleAxisd(-70 * deg, Vec3::UnitY()))
               : Quat(Eigen::AngleAxisd(80 * deg, Vec3::UnitY())) * Quat(Eigen::AngleAxisd(0.35, Vec3::UnitZ()));
  add_figure(model, X);
  const auto& figure = model.persons.front().bodies;
  lift(model, figure, {0, shift, 1 - lowest_point(model, figure)});
  if (thrown)
    for (const int b : figure) model.bodies[b].V_WB.v = {10, 0, 0};
  return model;
}

void tilt(Model& model, double angle) {
  const Vec3 about = model.bodies[model.persons.front().bodies.front()].X_WB.p;
  const Quat turn(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  for (const int b : model.persons.front().bodies) {
    Pose& X = model.bodies[b].X_WB;
    X = {about + turn * (X.p - about), turn * X.q};
  }
}

void give_capsules(Model& model) {
  constexpr double kBall = 1e-3;  // [kg]
  const std::vector<int> segments = model.persons.front().bodies;
  for (const int s : segments) {
    const Vec3 axes = std::get<engine::HyperEllipsoid>(model.bodies[s].shape).semi_axes;
    model.bodies[s].shape = std::monostate{};
    for (const double side : {-1.0, 0.0, 1.0}) {
      Body ball = model.bodies[s];
      Joint joint;
      joint.name = ball.name += "_ball";
      joint.kind = JointKind::fixed;
      joint.parent = s;
      joint.child = static_cast<int>(model.bodies.size());
      joint.X_PF.p.z() = side * (axes.z() - axes.x());
      ball.mass = kBall;
      ball.inertia_B = Vec3::Constant(0.4 * kBall * axes.x() * axes.x()).asDiagonal();
      ball.shape = engine::HyperEllipsoid{Vec3::Constant(axes.x()), 2};
      ball.X_WB.p = ball.X_WB * joint.X_PF.p;
      model.bodies.push_back(ball);
      model.joints.push_back(joint);
      model.persons.front().bodies.push_back(joint.child);
    }
  }
}

Model crowd(const std::string& what, int first, int count, double step) {
  constexpr double kFaster = 0.002, kHigher = 2e-4;  // [-], [m] from one to the next
  const double deg = std::numbers::pi / 180;
  Model model = empty(1.0, step);
  const auto mesh = car_mesh(1000);  // one for all, as a scene has it whose cars name the same file
  for (int k = 0; k < count; ++k) {
    const Vec3 place(0, 5.0 * k, 0);
    const double faster = 1 + kFaster * (first + k), higher = kHigher * (first + k);
    if (what == "struck") {
      add_figure(model, turned(0, Vec3::UnitX(), 90 * deg, place + Vec3(0, 0.05, 0)));
      add_car(model, mesh, place + Vec3(-2.6, 0, 0.6));
      model.bodies.back().V_WB.v *= faster;
      continue;
    }
    add_figure(model, turned((what == "lying" ? 89 : -70) * deg, Vec3::UnitY(), 0.3, place));
    const auto figure = model.persons.back().bodies;
    lift(model, figure, {0, 0, (what == "lying" ? 0.01 + higher : 0.3) - lowest_point(model, figure)});
    if (what == "thrown")
      for (const int b : figure) model.bodies[b].V_WB.v = {10 * faster, 0, 0};
  }
  return model;
}

Model struck_by_mesh(int triangles, double step) {
  Model model = empty(1.0, step);
  add_figure(model, turned(0, Vec3::UnitX(), std::numbers::pi / 2, {0, 0.05, 0}));
  add_car(model, car_mesh(triangles), {-2.6, 0, 0.6});
  return model;
}

}  // namespace benchmark
