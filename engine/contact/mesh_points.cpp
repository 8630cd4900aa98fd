#include "engine/contact/mesh_points.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "engine/contact/road.h"
#include "engine/contact/round_tyre.h"
#include "engine/geometry/mesh_overlap.h"
#include "engine/geometry/point_mesh.h"
#include "engine/math/functions.h"
#include "engine/world.h"

namespace engine {

Vec3 rim_point(const Wheel& wheel, int i) {
  static const auto kSpokes = [] {
    std::array<Vec3, kRing> out;
    for (int k = 0; k < kRing; ++k) {
      const double angle = 2 * std::numbers::pi * k / kRing;
      out[static_cast<std::size_t>(k)] = {math::cos(angle), 0, math::sin(angle)};
    }
    return out;
  }();
  const int side = i / kRing - 1;
  const double radius = wheel.radius - (side == 0 ? 0 : crown_radius(wheel));
  return wheel.hub_B + radius * kSpokes[static_cast<std::size_t>(i % kRing)] + 0.5 * side * wheel.width * Vec3::UnitY();
}

namespace {

constexpr double kSpacing = 0.10;       // [m] between the points that stand for a mesh
constexpr double kDeepestPoint = 0.15;  // [m] a point farther behind a surface has come from its other side
constexpr double kAside = 0.8;          // [-] cosine to the axle: what a flank meets is not mounted
constexpr double kClear = 0.05;         // [m] from a coupled vehicle: nearer at the start, and they never meet there

/// Points that stand for a body's mesh and, of a vehicle, for its wheels, of which `first_wheel` is the number of the first.
std::vector<SurfacePoint> points_of(const Model& model, const Body& body, int first_wheel, PointsOf of) {
  std::vector<SurfacePoint> out;
  const auto& shape = std::get<MeshShape>(body.shape);
  // of walls, rails and slabs; the few points of a thin moving mesh, a bicycle, hold it whichever way their faces look
  const WithNormals with = body.fixed ? WithNormals::yes : WithNormals::no;
  for (const RepresentativePoint& point : representative_points(*shape.mesh, kSpacing, of, with)) {
    out.push_back({.p_B = shape.X_BM * point.p});
    for (const Vec3& n : point.normals) out.back().normals_B.push_back(shape.X_BM.q * n);
  }
  if (body.vehicle < 0) return out;
  for (const Wheel& wheel : model.vehicles[body.vehicle].wheels) {
    for (int i = 0; i < kRimPoints; ++i) {
      const Vec3 p = rim_point(wheel, i), arm = p - wheel.hub_B;
      out.push_back({.p_B = p, .wheel = first_wheel, .radius = math::hypot(arm.x(), arm.z())});
    }
    ++first_wheel;
  }
  return out;
}

/// What stands on the ground has nothing under it: the underside of a ramp's thin end would press down what comes over its top.
bool faces_ground(const Ground& ground, const SurfaceContact& c) {
  constexpr double kDown = -0.5, kStands = 5e-3;  // [-], [m]
  return ground.plane && c.normal.z() < kDown && c.p_b.z() < ground.height + kStands;
}

/// A point presses on the other's surface only between the normals of its own faces: the normal found is turned to the nearest of
/// those. False if they are too far apart: the point of a wall's edge that lies within the front of what slides along the wall.
bool turn_between(const std::vector<Vec3>& normals_B, const Quat& q_WB, SurfaceContact& c) {
  constexpr double kLeast = 0.2;  // [-] cosine
  if (normals_B.empty()) return true;
  const Vec3 d_B = q_WB.conjugate() * -c.normal;
  const Vec3 turned = nearest_in_cone(normals_B, d_B);
  if (turned == d_B) return true;
  const double size = turned.norm();
  if (size < kLeast) return false;
  c.normal = q_WB * (-turned / size);
  c.p_b = c.p_a - c.gap * c.normal;
  return true;
}

void reserve_scratch(const Model& model, ContactPairs& pairs) {
  std::size_t triangles = model.ground.terrain ? model.ground.terrain->triangles().size() : 0;
  for (const Body& body : model.bodies)
    if (is_mesh(body)) triangles = std::max(triangles, std::get<MeshShape>(body.shape).mesh->triangles().size());
  pairs.point_scratch.reserve(triangles);
}

void reserve_contacts(ContactPairs& pairs) {
  std::size_t points = 0;
  for (const auto& of_body : pairs.points) points = std::max(points, of_body.size());
  for (const auto& of_pair : pairs.bodywork_points)
    for (const SurfacePoints& of_body : of_pair) points = std::max(points, of_body->size());
  pairs.point_contacts.reserve(points);
}

/// The points of a body that stand clear of the one it is coupled to at the start: those about the coupling do not.
SurfacePoints clear_points(const Model& model, int body, int other, ContactPairs& pairs) {
  const auto& shape = std::get<MeshShape>(model.bodies[other].shape);
  const Pose X_MB = (model.bodies[other].X_WB * shape.X_BM).inverse() * model.bodies[body].X_WB;
  std::vector<SurfacePoint> out = pairs.points[body];
  std::erase_if(out, [&](const SurfacePoint& p) {
    const auto surface = nearest_surface(*shape.mesh, X_MB * p.p_B, kDeepestPoint, pairs.point_scratch);
    return surface && surface->gap < kClear;
  });
  return std::make_shared<const std::vector<SurfacePoint>>(std::move(out));
}

}  // namespace

bool coupled(const Model& model, int a, int b) {
  return model.bodies[a].vehicle >= 0 && model.bodies[b].vehicle >= 0 && jointed(model, a, b);
}

bool meshes_meet(const Model& model, int a, int b) {
  const Body& A = model.bodies[a];
  const Body& B = model.bodies[b];
  if (!is_mesh(A) || !is_mesh(B) || (A.fixed && B.fixed) || (A.person >= 0 && A.person == B.person)) return false;
  if (jointed(model, a, b)) return coupled(model, a, b);
  return model_between(A.collision_model, B.collision_model) != CollisionModel::kudlich_slibar;
}

std::vector<BodyPair> wheeled_pairs(const Model& model) {
  std::vector<BodyPair> out;
  for (std::size_t i = 0; i < model.vehicles.size(); ++i)
    for (std::size_t k = i + 1; k < model.vehicles.size(); ++k) {
      const int a = model.vehicles[i].body, b = model.vehicles[k].body;
      const auto law = model_between(model.bodies[a].collision_model, model.bodies[b].collision_model);
      const bool wheels = !model.vehicles[i].wheels.empty() && !model.vehicles[k].wheels.empty();
      if (wheels && law == CollisionModel::default_auto && !jointed(model, a, b)) out.push_back({a, b});
    }
  return out;
}

void list_mesh_pairs(const Model& model, ContactPairs& pairs) {
  const auto& bodies = model.bodies;
  pairs.points.assign(bodies.size(), {});
  std::vector<int> first_wheel;  // of each vehicle, as in State::wheels
  int wheels = 0;
  for (const Vehicle& vehicle : model.vehicles) {
    first_wheel.push_back(wheels);
    wheels += static_cast<int>(vehicle.wheels.size());
  }
  const auto points = [&](int b, PointsOf of) {
    const int vehicle = bodies[b].vehicle;
    return points_of(model, bodies[b], vehicle < 0 ? 0 : first_wheel[vehicle], of);
  };
  for (int b = 0; b < static_cast<int>(bodies.size()); ++b)
    if (is_mesh(bodies[b])) pairs.points[b] = points(b, PointsOf::vertices);
  for (int a = 0; a < static_cast<int>(bodies.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(bodies.size()); ++b)
      if (meshes_meet(model, a, b)) pairs.bodywork.push_back({a, b});
  reserve_scratch(model, pairs);
  std::vector<SurfacePoints> known(bodies.size());
  const auto all_points = [&](int b) {
    if (!known[b]) known[b] = std::make_shared<const std::vector<SurfacePoint>>(points(b, PointsOf::vertices_and_edges));
    return known[b];
  };
  for (const BodyPair& pair : pairs.bodywork)
    if (coupled(model, pair.a, pair.b))
      pairs.bodywork_points.push_back({clear_points(model, pair.a, pair.b, pairs), clear_points(model, pair.b, pair.a, pairs)});
    else
      pairs.bodywork_points.push_back({all_points(pair.a), all_points(pair.b)});
  reserve_contacts(pairs);
}

Aabb box_of(const World& world, const Motion& state, int body) {
  const auto& shape = std::get<MeshShape>(world.model.bodies[body].shape);
  Aabb box = world_bounds(*shape.mesh, state.X_WB[body] * shape.X_BM);
  if (const int v = world.model.bodies[body].vehicle; v >= 0)
    for (const Wheel& wheel : world.model.vehicles[v].wheels) {
      const Vec3 hub = state.X_WB[body] * wheel.hub_B;
      const double r = math::hypot(wheel.radius, 0.5 * wheel.width) + 2 * wheel.travel;
      box.lower = box.lower.cwiseMin((hub.array() - r).matrix());
      box.upper = box.upper.cwiseMax((hub.array() + r).matrix());
    }
  return box;
}

std::size_t first_of_wheels(const std::vector<SurfacePoint>& points) {
  const auto first = std::partition_point(points.begin(), points.end(), [](const SurfacePoint& p) { return p.wheel < 0; });
  return static_cast<std::size_t>(first - points.begin());
}

void touch_with_points(const Outlook& outlook, int body, const std::vector<SurfacePoint>& points, PointRange which,
                       const PointTarget& target, double margin) {
  World& world = outlook.world;
  std::vector<SurfaceContact>& out = world.pairs.point_contacts;
  out.clear();
  const Pose& X = outlook.at.X_WB[body];
  const Vec3 up = X.q * Vec3::UnitZ();
  const Vec3 axle = X.q * Vec3::UnitY();
  const Pose X_MW = target.X_WM.inverse();
  for (std::size_t i = which.begin; i < which.end; ++i) {
    Vec3 p = X * points[i].p_B;
    if (points[i].wheel >= 0 && !outlook.state.wheels.empty()) p += outlook.state.wheels[points[i].wheel].lift * up;
    if ((p.array() < target.within.lower.array() - margin).any() || (p.array() > target.within.upper.array() + margin).any())
      continue;
    SurfaceContact c;
    c.p_a = p;
    c.key = static_cast<std::uint32_t>(i);
    if (target.mesh) {
      const auto surface = nearest_surface(*target.mesh, X_MW * p, std::max(margin, kDeepestPoint), world.pairs.point_scratch);
      if (!surface || surface->gap >= margin || surface->gap < target.least) continue;
      c.p_b = target.X_WM * surface->point;
      c.normal = target.X_WM.q * surface->normal;
      c.gap = surface->gap;
      if (!target.is_ground && !turn_between(points[i].normals_B, X.q, c)) continue;
      if (faces_ground(world.model.ground, c)) continue;
    } else {
      c.gap = p.z() - target.height;
      if (c.gap >= margin) continue;
      c.p_b = p - c.gap * Vec3::UnitZ();
    }
    if (points[i].wheel >= 0) {
      c.gap = given(c.gap);  // it may come from its tread down onto its flank pressed in by millimetres
      c.rolls = c.normal.dot(up) > target.rolls;
      if (c.rolls && (target.is_ground || (target.road && carries(outlook, points[i].wheel, *target.road)))) continue;
      const bool ahead = !c.rolls && std::abs(c.normal.dot(axle)) < kAside;
      if (target.road && ahead && mounts(outlook, points[i].wheel, points[i].radius, *target.road, c)) continue;
    }
    out.push_back(c);
  }
  keep_spread(out, static_cast<std::size_t>(world.model.settings.contacts_per_pair));
}

}  // namespace engine
