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
#include "engine/effects/registration.h"
#include "engine/effects/words.h"
#include "engine/geometry/mesh_overlap.h"
#include "engine/geometry/point_mesh.h"
#include "engine/math/functions.h"

namespace engine {
namespace {

constexpr double kSpacing = 0.10;  // [m] between the points that stand for a mesh
constexpr double kDeepest = 0.15;  // [m] a point farther behind a surface has come from its other side,
constexpr double kClear = 0.05;    // [m] from a coupled vehicle: nearer at the start, and they never meet there
constexpr double kFarther = 0.01;  // [m] and one that is so much deeper than the last look and the way since allow
constexpr double kNotKnown = -std::numeric_limits<double>::infinity();
constexpr int kRing = 24;             // points round a wheel, in the middle and on either flank
constexpr double kUnderWheel = 0.75;  // [-] cosine to the vehicle's up axis: other meshes nearer to level carry no wheel

/// A towing vehicle and its trailer.
bool coupled(const Model& model, int a, int b) {
  return model.bodies[a].vehicle >= 0 && model.bodies[b].vehicle >= 0 && jointed(model, a, b);
}

bool can_meet(const Model& model, int a, int b) {
  const Body& A = model.bodies[a];
  const Body& B = model.bodies[b];
  if (!is_mesh(A) || !is_mesh(B) || (A.fixed && B.fixed) || (A.person >= 0 && A.person == B.person)) return false;
  if (jointed(model, a, b)) return coupled(model, a, b);
  return model_between(A.collision_model, B.collision_model) != CollisionModel::kudlich_slibar;
}

/// A pair that meets by Default-Auto, and why: which of the two does not ask for Kudlich-Slibar.
std::string with_law(const Model& model, int body_a, int body_b) {
  const Body &a = model.bodies[body_a], &b = model.bodies[body_b];
  if (coupled(model, body_a, body_b)) return a.name + " with " + b.name + " (default_auto: coupled)";
  const bool from_a = a.collision_model == CollisionModel::kudlich_slibar,
             from_b = b.collision_model == CollisionModel::kudlich_slibar;
  const std::string who = from_a ? b.name + " does" : from_b ? a.name + " does" : "both do";
  return a.name + " with " + b.name + " (default_auto: " + who + " not ask for kudlich_slibar)";
}

Finding look_at(const Model& model) {
  std::vector<std::string> moving, pairs;
  const int n = static_cast<int>(model.bodies.size());
  for (int a = 0; a < n; ++a) {
    if (is_mesh(model.bodies[a]) && !model.bodies[a].fixed) moving.push_back(model.bodies[a].name);
    for (int b = a + 1; b < n; ++b)
      if (can_meet(model, a, b)) pairs.push_back(with_law(model, a, b));
  }
  const bool ground = model.ground.plane || model.ground.terrain;
  if (moving.empty()) return {false, "no vehicle and no other mesh that moves", ""};
  if (pairs.empty() && !ground) return {false, "no ground, and no second mesh to meet", ""};
  std::string reason = ground ? listed(moving) + " can touch the ground with its body (kerb, slope, rollover)" : "";
  if (moving.size() > 1 && ground) reason = listed(moving) + " can touch the ground with their bodies (kerb, slope, rollover)";
  if (!pairs.empty()) reason += (ground ? ", and " : "") + listed(pairs) + (ground ? "" : " can touch");
  std::vector<std::string> held, towing;
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b)
      if (is_mesh(model.bodies[a]) && is_mesh(model.bodies[b]) && model.bodies[a].person < 0 && jointed(model, a, b))
        (coupled(model, a, b) ? towing : held).push_back(model.bodies[a].name + " with " + model.bodies[b].name);
  std::string left_out = "meshes whose boxes a step cannot bring together: exact";
  if (!held.empty()) left_out += "; " + listed(held) + ", which a joint holds";
  if (!towing.empty())
    left_out += "; of " + listed(towing) + " what stands within 5 cm of the other at the start, about the coupling";
  return {true, reason, left_out};
}

/// Points that stand for a body's mesh and, of a vehicle, for its wheels, of which `first_wheel` is the number of the first.
std::vector<SurfacePoint> points_of(const Model& model, const Body& body, int first_wheel) {
  std::vector<SurfacePoint> out;
  const auto& shape = std::get<MeshShape>(body.shape);
  for (const Vec3& p : representative_points(*shape.mesh, kSpacing)) out.push_back({shape.X_BM * p});
  if (body.vehicle < 0) return out;
  for (const Wheel& wheel : model.vehicles[body.vehicle].wheels) {
    for (const double side : {-1.0, 0.0, 1.0})
      for (int i = 0; i < kRing; ++i) {
        const double angle = 2 * std::numbers::pi * i / kRing;
        const double radius = wheel.radius - (side == 0 ? 0 : crown_radius(wheel));
        const Vec3 spoke(radius * math::cos(angle), 0.5 * side * wheel.width, radius * math::sin(angle));
        out.push_back({wheel.hub_B + spoke, first_wheel});
      }
    ++first_wheel;
  }
  return out;
}

void reserve_scratch(const Model& model, ContactPairs& pairs) {
  std::size_t triangles = model.ground.terrain ? model.ground.terrain->triangles().size() : 0, points = 0;
  for (const Body& body : model.bodies)
    if (is_mesh(body)) triangles = std::max(triangles, std::get<MeshShape>(body.shape).mesh->triangles().size());
  for (const auto& of_body : pairs.points) points = std::max(points, of_body.size());
  pairs.point_scratch.reserve(triangles);
  pairs.point_contacts.reserve(points);
}

/// The points of a body that stand clear of the one it is coupled to at the start: those about the coupling do not.
std::vector<SurfacePoint> clear_points(const Model& model, int body, int other, ContactPairs& pairs) {
  const auto& shape = std::get<MeshShape>(model.bodies[other].shape);
  const Pose X_MB = (model.bodies[other].X_WB * shape.X_BM).inverse() * model.bodies[body].X_WB;
  std::vector<SurfacePoint> out = pairs.points[body];
  std::erase_if(out, [&](const SurfacePoint& p) {
    const auto surface = nearest_surface(*shape.mesh, X_MB * p.p_B, kDeepest, pairs.point_scratch);
    return surface && surface->gap < kClear;
  });
  return out;
}

void list_pairs(const Model& model, ContactPairs& pairs) {
  const auto& bodies = model.bodies;
  pairs.points.assign(bodies.size(), {});
  std::vector<int> first_wheel;  // of each vehicle, as in State::wheels
  int wheels = 0;
  for (const Vehicle& vehicle : model.vehicles) {
    first_wheel.push_back(wheels);
    wheels += static_cast<int>(vehicle.wheels.size());
  }
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (is_mesh(bodies[b]))
      pairs.points[b] = points_of(model, bodies[b], bodies[b].vehicle < 0 ? 0 : first_wheel[bodies[b].vehicle]);
  for (int a = 0; a < static_cast<int>(bodies.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(bodies.size()); ++b)
      if (can_meet(model, a, b)) pairs.bodywork.push_back({a, b});
  reserve_scratch(model, pairs);
  for (const BodyPair& pair : pairs.bodywork)
    if (coupled(model, pair.a, pair.b))
      pairs.bodywork_points.push_back({clear_points(model, pair.a, pair.b, pairs), clear_points(model, pair.b, pair.a, pairs)});
    else
      pairs.bodywork_points.push_back({pairs.points[pair.a], pairs.points[pair.b]});
}

/// Box around a body's points in world axes.
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
void touch(const Outlook& outlook, int body, const std::vector<SurfacePoint>& points, Points which, const TriangleMesh* mesh,
           const Pose& X_WM, double height, double margin, const Aabb& within, double rolls, double least) {
  World& world = outlook.world;
  const Motion& state = outlook.at;
  std::vector<SurfaceContact>& out = world.pairs.point_contacts;
  out.clear();
  const Pose& X = state.X_WB[body];
  const Vec3 up = X.q * Vec3::UnitZ();
  const Pose X_MW = X_WM.inverse();
  for (std::size_t i = which.begin; i < which.end; ++i) {
    Vec3 p = X * points[i].p_B;
    if (points[i].wheel >= 0 && !outlook.state.wheels.empty()) p += outlook.state.wheels[points[i].wheel].lift * up;
    if ((p.array() < within.lower.array() - margin).any() || (p.array() > within.upper.array() + margin).any()) continue;
    SurfaceContact c;
    c.p_a = p;
    c.key = static_cast<std::uint32_t>(i);
    if (mesh) {
      const auto surface = nearest_surface(*mesh, X_MW * p, std::max(margin, kDeepest), world.pairs.point_scratch);
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

void find_on_ground(ContactSearch& search, int body, int self) {
  World& world = search.world;
  const Motion& at = search.at;
  const Ground& ground = world.model.ground;
  const Body& B = world.model.bodies[body];
  const double margin = contact_margin(search, body);
  const Aabb box = box_of(world, at, body);
  const double e = restitution_on_ground(B, ground, at.time);
  auto add = [&](int under) {
    for (const SurfaceContact& c : world.pairs.point_contacts)
      add_contact(search, c, body, under, self, {friction_on_ground(B, ground, c.p_b, at.time), e});
  };
  const std::vector<SurfacePoint>& points = world.pairs.points[body];
  const std::size_t wheels = first_of_wheels(points), all = points.size();
  if (ground.plane && box.lower.z() < ground.height + margin) {
    // of a vehicle that stands upright and clear of the road neither its mesh nor its wheels: the road is under them
    const auto& shape = std::get<MeshShape>(B.shape);
    const bool low = world_bounds(*shape.mesh, at.X_WB[body] * shape.X_BM).lower.z() < ground.height + margin;
    const bool upright = (at.X_WB[body].q * Vec3::UnitZ()).z() > kWheelFacing;
    touch(search, body, points, {low ? 0 : wheels, upright ? wheels : all}, nullptr, {}, ground.height, margin, box, kWheelFacing,
          kNotKnown);
    add(kPlane);
  }
  if (ground.terrain) {
    touch(search, body, points, {0, all}, ground.terrain.get(), {}, 0, margin, ground.terrain->bounds(), kWheelFacing, kNotKnown);
    for (SurfaceContact& c : world.pairs.point_contacts) c.key |= 0x400000u;
    add(kTerrain);
  }
}

/// Where the boxes of a pair meet; nothing if a step cannot bring them together.
std::optional<Aabb> shared_box(const Outlook& outlook, std::size_t which, double margin) {
  const BodyPair& pair = outlook.world.pairs.bodywork[which];
  const Motion& at = outlook.at;
  const Aabb box_a = box_of(outlook.world, at, pair.a), box_b = box_of(outlook.world, at, pair.b);
  const Aabb shared{box_a.lower.cwiseMax(box_b.lower), box_a.upper.cwiseMin(box_b.upper)};
  if ((shared.lower.array() <= shared.upper.array() + margin).all()) return shared;
  for (Clearance& clearance : outlook.state.contact_memory.bodywork[which])
    clearance = {0, at.X_WB[pair.a].inverse() * at.X_WB[pair.b]};
  return std::nullopt;
}

/// Points of a pair's first body on the surface of the second (way 0) or of the second on the first (way 1), to
/// ContactPairs::point_contacts.
void touch_one_way(const Outlook& outlook, std::size_t which, int way, double margin, const Aabb& within) {
  const World& world = outlook.world;
  const BodyPair& pair = world.pairs.bodywork[which];
  const Motion& at = outlook.at;
  const int points_of = way == 0 ? pair.a : pair.b, surface_of = way == 0 ? pair.b : pair.a;
  const Pose X_AB = at.X_WB[pair.a].inverse() * at.X_WB[pair.b];
  Clearance& clearance = outlook.state.contact_memory.bodywork[which][static_cast<std::size_t>(way)];
  const auto& shape = std::get<MeshShape>(world.model.bodies[surface_of].shape);
  const std::vector<SurfacePoint>& points = world.pairs.bodywork_points[which][static_cast<std::size_t>(way)];
  touch(outlook, points_of, points, {0, points.size()}, shape.mesh.get(), at.X_WB[surface_of] * shape.X_BM, 0, margin, within,
        kUnderWheel, clearance.by_now(X_AB, world.reach[pair.b]) - kFarther);
  clearance = {0, X_AB};
  for (const SurfaceContact& c : world.pairs.point_contacts) clearance.least = std::min(clearance.least, c.gap);
}

void find_between(ContactSearch& search, std::size_t which, int self) {
  const World& world = search.world;
  const BodyPair& pair = world.pairs.bodywork[which];
  const double margin = pair_margin(search, pair.a, pair.b);
  const std::optional<Aabb> within = shared_box(search, which, margin);
  if (!within) return;
  const SurfacePairing surfaces = between_bodies(world.model.bodies[pair.a], world.model.bodies[pair.b], search.at.time);
  for (const int way : {0, 1}) {
    touch_one_way(search, which, way, margin, *within);
    for (const SurfaceContact& c : world.pairs.point_contacts)
      add_contact(search, c, way == 0 ? pair.a : pair.b, way == 0 ? pair.b : pair.a, self, surfaces);
  }
}

bool frozen(const World& world, int body) {
  return !world.awake[body] && !world.model.bodies[body].fixed;  // waits or sleeps: those effects watch
}

}  // namespace

const std::vector<SurfaceContact>& contacts_of_meshes(const Outlook& outlook, int a, int b) {
  ContactPairs& pairs = outlook.world.pairs;
  pairs.point_contacts.clear();
  const auto pair = std::find_if(pairs.bodywork.begin(), pairs.bodywork.end(),
                                 [&](const BodyPair& p) { return p.a == std::min(a, b) && p.b == std::max(a, b); });
  if (pair == pairs.bodywork.end()) return pairs.point_contacts;
  const auto which = static_cast<std::size_t>(pair - pairs.bodywork.begin());
  const double margin = pair_margin(outlook, a, b);
  const std::optional<Aabb> within = shared_box(outlook, which, margin);
  if (!within) return pairs.point_contacts;
  const int way = pair->a == a ? 0 : 1;
  touch_one_way(outlook, which, way, margin, *within);
  if (!pairs.point_contacts.empty()) return pairs.point_contacts;
  touch_one_way(outlook, which, 1 - way, margin, *within);
  for (SurfaceContact& c : pairs.point_contacts) {
    std::swap(c.p_a, c.p_b);
    c.normal = -c.normal;
  }
  return pairs.point_contacts;
}

class BodyworkContact final : public Effect {
 public:
  static constexpr const char* kName = "bodywork_contact";
  static Finding look(const Model& model) { return look_at(model); }
  static bool gives(const Model& model) { return model.settings.contact_law != ContactLaw::default_auto; }

  BodyworkContact(World& world, int self) : Effect(self) { list_pairs(world.model, world.pairs); }

  void find_contacts(ContactSearch& search) override {
    const World& world = search.world;
    const int n = static_cast<int>(world.model.bodies.size());
    const std::vector<int>& tree = world.topology.tree_of_body;
    const std::vector<BodyPair>& pairs = world.pairs.bodywork;
    std::size_t i = 0;
    for (int a = 0; a < n; ++a) {
      if (is_mesh(world.model.bodies[a]) && world.awake[a]) find_on_ground(search, a, self_);
      for (; i < pairs.size() && pairs[i].a == a; ++i)
        if (world.pairs.broad_phase.close(tree[a], tree[pairs[i].b]) && !frozen(world, a) && !frozen(world, pairs[i].b))
          find_between(search, i, self_);
    }
  }
};
template struct Registered<BodyworkContact>;

}  // namespace engine
