// The mesh of a vehicle (or of any body) against ground, terrain and other meshes by Default-Auto, at many points through the one
// contact solver: rollover, landing on the roof, a kerb, cars that do not both ask for Kudlich-Slibar. Points of each mesh are
// held against the other's surface. What lies under a wheel is its suspension's business; what it meets sideways, or lies on when
// the vehicle has turned over, touches its rim and flanks here.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "engine/effects/bodywork_contact.h"
#include "engine/effects/effects.h"
#include "engine/effects/words.h"
#include "engine/geometry/mesh_overlap.h"
#include "engine/geometry/point_mesh.h"
#include "engine/math/functions.h"

namespace engine {
namespace {

constexpr double kSpacing = 0.10;  // [m] between the points that stand for a mesh
constexpr double kDeepest = 0.15;  // [m] a point farther behind a surface has come from its other side,
constexpr double kFarther = 0.01;  // [m] and one that is so much deeper than the last look and the way since allow
constexpr double kNotKnown = -std::numeric_limits<double>::infinity();
constexpr int kRing = 24;             // points round a wheel, in the middle and on either flank
constexpr double kUnderWheel = 0.75;  // [-] cosine to the vehicle's up axis: other meshes nearer to level carry no wheel

bool can_meet(const Model& model, int a, int b) {
  const Body& A = model.bodies[a];
  const Body& B = model.bodies[b];
  if (!is_mesh(A) || !is_mesh(B) || (A.fixed && B.fixed) || (A.person >= 0 && A.person == B.person)) return false;
  if (model_between(A.collision_model, B.collision_model) == CollisionModel::kudlich_slibar) return false;
  return !jointed(model, a, b);
}

Finding look(const Model& model) {
  std::vector<std::string> moving, pairs;
  const int n = static_cast<int>(model.bodies.size());
  for (int a = 0; a < n; ++a) {
    if (is_mesh(model.bodies[a]) && !model.bodies[a].fixed) moving.push_back(model.bodies[a].name);
    for (int b = a + 1; b < n; ++b)
      if (can_meet(model, a, b)) pairs.push_back(model.bodies[a].name + " with " + model.bodies[b].name);
  }
  const bool ground = model.ground.plane || model.ground.terrain;
  if (moving.empty()) return {false, "no vehicle and no other mesh that moves", ""};
  if (pairs.empty() && !ground) return {false, "no ground, and no second mesh to meet", ""};
  std::string reason = ground ? listed(moving) + " can touch the ground with its body (kerb, slope, rollover)" : "";
  if (moving.size() > 1 && ground) reason = listed(moving) + " can touch the ground with their bodies (kerb, slope, rollover)";
  if (!pairs.empty()) reason += (ground ? ", and " : "") + listed(pairs) + (ground ? "" : " can touch");
  return {true, reason, "meshes whose boxes a step cannot bring together: exact"};
}

void reserve_scratch(World& world) {
  std::size_t triangles = world.model.ground.terrain ? world.model.ground.terrain->triangles().size() : 0, points = 0;
  for (const Body& body : world.model.bodies)
    if (is_mesh(body)) triangles = std::max(triangles, std::get<MeshShape>(body.shape).mesh->triangles().size());
  for (const auto& of_body : world.surface_points) points = std::max(points, of_body.size());
  world.point_scratch.reserve(triangles);
  world.point_contacts.reserve(points);
}

void begin(World& world, const State&, int) {
  const auto& bodies = world.model.bodies;
  world.surface_points.assign(bodies.size(), {});
  std::vector<int> first_wheel;  // of each vehicle, as in World::wheels
  int wheels = 0;
  for (const Vehicle& vehicle : world.model.vehicles) {
    first_wheel.push_back(wheels);
    wheels += static_cast<int>(vehicle.wheels.size());
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!is_mesh(bodies[b])) continue;
    const auto& shape = std::get<MeshShape>(bodies[b].shape);
    for (const Vec3& p : representative_points(*shape.mesh, kSpacing)) world.surface_points[b].push_back({shape.X_BM * p});
    if (bodies[b].vehicle < 0) continue;
    int index = first_wheel[bodies[b].vehicle];
    for (const Wheel& wheel : world.model.vehicles[bodies[b].vehicle].wheels) {
      for (const double side : {-1.0, 0.0, 1.0})
        for (int i = 0; i < kRing; ++i) {
          const double angle = 2 * std::numbers::pi * i / kRing;
          const double radius = wheel.radius - (side == 0 ? 0 : crown_radius(wheel));
          const Vec3 spoke(radius * math::cos(angle), 0.5 * side * wheel.width, radius * math::sin(angle));
          world.surface_points[b].push_back({wheel.hub_B + spoke, index});
        }
      ++index;
    }
  }
  for (int a = 0; a < static_cast<int>(bodies.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(bodies.size()); ++b)
      if (can_meet(world.model, a, b)) world.bodywork_pairs.push_back({a, b});
  world.bodywork_clearances.resize(world.bodywork_pairs.size());
  reserve_scratch(world);
}

/// Box around a body's points in world axes.
Aabb box_of(const World& world, const State& state, int body) {
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

/// Some of a body's points: those of its mesh stand before those of its wheels.
struct Points {
  std::size_t begin = 0, end = 0;
};
std::size_t first_of_wheels(const std::vector<SurfacePoint>& points) {
  const auto first = std::partition_point(points.begin(), points.end(), [](const SurfacePoint& p) { return p.wheel < 0; });
  return static_cast<std::size_t>(first - points.begin());
}

/// Contacts of a body's points with a mesh at a pose, or with the plane z = height where there is none. Of its wheels only with
/// what is steeper to its up axis than `rolls` [-] says: the rest is under them. What has a gap below `least` [m] is not met.
void touch(World& world, const State& state, int body, Points which, const TriangleMesh* mesh, const Pose& X_WM, double height,
           double margin, const Aabb& within, double rolls, double least) {
  std::vector<SurfaceContact>& out = world.point_contacts;
  out.clear();
  const Pose& X = state.X_WB[body];
  const Vec3 up = X.q * Vec3::UnitZ();
  const Pose X_MW = X_WM.inverse();
  const auto& points = world.surface_points[body];
  for (std::size_t i = which.begin; i < which.end; ++i) {
    Vec3 p = X * points[i].p_B;
    if (points[i].wheel >= 0 && !world.wheels.empty()) p += world.wheels[points[i].wheel].lift * up;
    if ((p.array() < within.lower.array() - margin).any() || (p.array() > within.upper.array() + margin).any()) continue;
    SurfaceContact c;
    c.p_a = p;
    c.key = static_cast<std::uint32_t>(i);
    if (mesh) {
      const auto surface = nearest_surface(*mesh, X_MW * p, std::max(margin, kDeepest), world.point_scratch);
      if (!surface || surface->gap >= margin || surface->gap < least) continue;
      c.p_b = X_WM * surface->point;
      c.normal = X_WM.q * surface->normal;
      c.gap = surface->gap;
    } else {
      c.gap = p.z() - height;
      if (c.gap >= margin) continue;
      c.p_b = p - c.gap * Vec3::UnitZ();
    }
    if (points[i].wheel >= 0 && c.normal.dot(up) > rolls) continue;
    out.push_back(c);
  }
  keep_spread(out, static_cast<std::size_t>(world.model.settings.contacts_per_pair));
}

void find_on_ground(World& world, const State& state, int body, int self) {
  const Ground& ground = world.model.ground;
  const Body& B = world.model.bodies[body];
  const double margin = contact_margin(world, state, body);
  const Aabb box = box_of(world, state, body);
  const double t = state.time;
  const double e = std::max(B.surface.restitution_ground.at(t), ground.surface.restitution_ground.at(t));
  auto add = [&](ContactKind kind) {
    for (const SurfaceContact& c : world.point_contacts) {
      const double mu = std::min(B.surface.friction_ground.at(t), ground.friction_at(c.p_b, t));
      add_contact(world, state, c, body, -1, self, kind, mu, e);
    }
  };
  const std::size_t wheels = first_of_wheels(world.surface_points[body]), all = world.surface_points[body].size();
  if (ground.plane && box.lower.z() < ground.height + margin) {
    // of a vehicle that stands upright and clear of the road neither its mesh nor its wheels: the road is under them
    const auto& shape = std::get<MeshShape>(B.shape);
    const bool low = world_bounds(*shape.mesh, state.X_WB[body] * shape.X_BM).lower.z() < ground.height + margin;
    const bool upright = (state.X_WB[body].q * Vec3::UnitZ()).z() > kWheelFacing;
    touch(world, state, body, {low ? 0 : wheels, upright ? wheels : all}, nullptr, {}, ground.height, margin, box, kWheelFacing,
          kNotKnown);
    add(ContactKind::ground);
  }
  if (ground.terrain) {
    touch(world, state, body, {0, all}, ground.terrain.get(), {}, 0, margin, ground.terrain->bounds(), kWheelFacing, kNotKnown);
    for (SurfaceContact& c : world.point_contacts) c.key |= 0x400000u;
    add(ContactKind::terrain);
  }
}

/// Where the boxes of a pair meet; nothing if a step cannot bring them together.
std::optional<Aabb> shared_box(World& world, const State& state, std::size_t which, double margin) {
  const BodyPair& pair = world.bodywork_pairs[which];
  const Aabb box_a = box_of(world, state, pair.a), box_b = box_of(world, state, pair.b);
  const Aabb shared{box_a.lower.cwiseMax(box_b.lower), box_a.upper.cwiseMin(box_b.upper)};
  if ((shared.lower.array() <= shared.upper.array() + margin).all()) return shared;
  for (Clearance& clearance : world.bodywork_clearances[which]) clearance = {0, state.X_WB[pair.a].inverse() * state.X_WB[pair.b]};
  return std::nullopt;
}

/// Points of a pair's first body on the surface of the second (way 0) or of the second on the first (way 1), to
/// World::point_contacts.
void touch_one_way(World& world, const State& state, std::size_t which, int way, double margin, const Aabb& within) {
  const BodyPair& pair = world.bodywork_pairs[which];
  const int points_of = way == 0 ? pair.a : pair.b, surface_of = way == 0 ? pair.b : pair.a;
  const Pose X_AB = state.X_WB[pair.a].inverse() * state.X_WB[pair.b];
  Clearance& clearance = world.bodywork_clearances[which][static_cast<std::size_t>(way)];
  const auto& shape = std::get<MeshShape>(world.model.bodies[surface_of].shape);
  touch(world, state, points_of, {0, world.surface_points[points_of].size()}, shape.mesh.get(), state.X_WB[surface_of] * shape.X_BM,
        0, margin, within, kUnderWheel, clearance.by_now(X_AB, world.reach[pair.b]) - kFarther);
  clearance = {0, X_AB};
  for (const SurfaceContact& c : world.point_contacts) clearance.least = std::min(clearance.least, c.gap);
}

void find_between(World& world, const State& state, std::size_t which, int self) {
  const BodyPair& pair = world.bodywork_pairs[which];
  const double margin = pair_margin(world, state, pair.a, pair.b);
  const std::optional<Aabb> within = shared_box(world, state, which, margin);
  if (!within) return;
  const SurfaceProperties& A = world.model.bodies[pair.a].surface;
  const SurfaceProperties& B = world.model.bodies[pair.b].surface;
  const double mu = std::min(A.friction_body.at(state.time), B.friction_body.at(state.time));
  const double e = std::max(A.restitution_body.at(state.time), B.restitution_body.at(state.time));
  for (const int way : {0, 1}) {
    touch_one_way(world, state, which, way, margin, *within);
    for (const SurfaceContact& c : world.point_contacts)
      add_contact(world, state, c, way == 0 ? pair.a : pair.b, way == 0 ? pair.b : pair.a, self, ContactKind::vehicle_pair, mu, e);
  }
}

bool frozen(const World& world, int body) {
  return !world.awake[body] && !world.model.bodies[body].fixed;  // waits or sleeps: those effects watch
}

void find(World& world, const State& state, int self) {
  const int n = static_cast<int>(world.model.bodies.size());
  const std::vector<int>& tree = world.topology.tree_of_body;
  const std::vector<BodyPair>& pairs = world.bodywork_pairs;
  std::size_t i = 0;
  for (int a = 0; a < n; ++a) {
    if (is_mesh(world.model.bodies[a]) && world.awake[a]) find_on_ground(world, state, a, self);
    for (; i < pairs.size() && pairs[i].a == a; ++i)
      if (world.nearness.close(tree[a], tree[pairs[i].b]) && !frozen(world, a) && !frozen(world, pairs[i].b))
        find_between(world, state, i, self);
  }
}

}  // namespace

const std::vector<SurfaceContact>& contacts_of_meshes(World& world, const State& state, int a, int b) {
  world.point_contacts.clear();
  const auto pair = std::find_if(world.bodywork_pairs.begin(), world.bodywork_pairs.end(),
                                 [&](const BodyPair& p) { return p.a == std::min(a, b) && p.b == std::max(a, b); });
  if (pair == world.bodywork_pairs.end()) return world.point_contacts;
  const auto which = static_cast<std::size_t>(pair - world.bodywork_pairs.begin());
  const double margin = pair_margin(world, state, a, b);
  const std::optional<Aabb> within = shared_box(world, state, which, margin);
  if (!within) return world.point_contacts;
  const int way = pair->a == a ? 0 : 1;
  touch_one_way(world, state, which, way, margin, *within);
  if (!world.point_contacts.empty()) return world.point_contacts;
  touch_one_way(world, state, which, 1 - way, margin, *within);
  for (SurfaceContact& c : world.point_contacts) {
    std::swap(c.p_a, c.p_b);
    c.normal = -c.normal;
  }
  return world.point_contacts;
}

const Effect kBodyworkContactEffect{.name = "bodywork_contact", .look = look, .begin = begin, .find_contacts = find};

}  // namespace engine
