#include "engine/effects/reach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "engine/effects/effect.h"
#include "engine/effects/underfoot.h"
#include "engine/effects/words.h"
#include "engine/geometry/mesh_overlap.h"
#include "engine/math/roots.h"

namespace engine {
namespace {

constexpr double kReachSpare = 0.05;  // [m] beyond every bound: contacts are looked for before they are needed
constexpr double kFaster = 1.05;      // [-] than every bound: for what a step's error may give
constexpr double kInGround = 1e-3;    // [m] deeper in it at the start a body is moved out
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Bodies that joints hold together, or one body.
struct ReachGroup {
  std::string name;
  std::vector<int> bodies;
  Vec3 centre = Vec3::Zero();  // [m] of mass
  double mass = 0;             // [kg]
  double extent = 0;           // [m] of its farthest point from there, at any time
  double speed = 0;            // [m/s] of the centre at most, and
  double gain = 0;             // [m/s^2] by which that bound grows
  bool fixed = false;
  bool climbs = false;  // walks over ground that is not level, and may walk off an edge
  bool steady = false;  // goes on at `velocity` as it stands until something touches it
  Vec3 velocity = Vec3::Zero();
  std::vector<Aabb> boxes;  // of its bodies at the start, where it is steady

  double way(double t) const { return kFaster * (speed * t + 0.5 * gain * t * t); }
};

bool waits(const Model& model, const Body& body) {
  if (body.person < 0) return false;
  const auto forced = model.settings.effects.find("zero_condition");
  const bool off = forced != model.settings.effects.end() && forced->second == Force::off;
  const Person& person = model.persons[body.person];
  return !off && person.zero_condition && person.mount < 0 && body.vehicle < 0;
}

/// Per body: a body of the same group.
std::vector<int> join(const Model& model) {
  std::vector<int> root(model.bodies.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&root](int b) {
    while (root[b] != b) b = root[b];
    return b;
  };
  for (const Joint& joint : model.joints)
    if (joint.parent >= 0) root[find(joint.child)] = find(joint.parent);
  for (int b = 0; b < static_cast<int>(root.size()); ++b) root[b] = find(b);
  return root;
}

double reach_of(const Model& model, const Body& body) {
  double reach = 0;
  if (const auto* shape = std::get_if<HyperEllipsoid>(&body.shape)) reach = shape->semi_axes.norm();
  if (const auto* shape = std::get_if<MeshShape>(&body.shape)) {
    const Aabb box = world_bounds(*shape->mesh, shape->X_BM);
    reach = box.lower.cwiseAbs().cwiseMax(box.upper.cwiseAbs()).norm();
  }
  if (body.vehicle >= 0)
    for (const Wheel& wheel : model.vehicles[body.vehicle].wheels)
      reach = std::max(reach, wheel.hub_B.norm() + wheel.radius + wheel.width + 2 * wheel.travel);
  return reach;
}

/// Does an effect give energy to all there is, as the wind does? Contacts and joints are asked by themselves.
bool something_drives(const Model& model) {
  const auto drives = [&model](const EffectKind* effect) {
    const bool of_pairs = effect->takes_part(Hook::find_contacts) || effect->takes_part(Hook::find_limits);
    return !of_pairs && !effect->takes_part(Hook::resist) && effect->gives && effect->gives(model);
  };
  const auto effects = effect_table();
  return std::any_of(effects.begin(), effects.end(), drives);
}

/// Has it, or may it get, energy that is not counted here?
bool is_unbounded(const Model& model, const ReachGroup& group, const std::vector<const Joint*>& joints) {
  if (model.settings.contact_law == ContactLaw::compliant || model.ground.terrain) return true;
  if (something_drives(model)) return true;
  for (const Joint* joint : joints) {
    if (joint->passive != PassiveTorque::none || std::isfinite(joint->breaking_force)) return true;
    for (int i = 0; i < kCoordinates; ++i)
      if (joint->coordinate(i).stiffness > 0 || joint->coordinate(i).stop_stiffness > 0) return true;
    const bool slides = joint->kind == JointKind::prismatic || joint->kind == JointKind::cylindrical;
    if (slides) return true;
  }
  return std::any_of(group.bodies.begin(), group.bodies.end(), [&](int b) {
    const Body& body = model.bodies[b];
    return body.person >= 0 || (model.ground.plane && box_at_start(body).lower.z() < model.ground.height - kInGround);
  });
}

/// [J] at the start: of its motion, of its suspensions pressed in all the way, and of its height over a level plane.
double energy_of(const Model& model, const ReachGroup& group, bool level) {
  double energy = 0;
  for (const int b : group.bodies) {
    const Body& body = model.bodies[b];
    const Vec3 w = body.X_WB.q.conjugate() * body.V_WB.w;
    energy += 0.5 * body.mass * body.V_WB.v.squaredNorm() + 0.5 * w.dot(body.inertia_B * w);
    if (body.vehicle < 0) continue;
    for (const Wheel& wheel : model.vehicles[body.vehicle].wheels) {
      const double pressed = wheel.travel + group.mass * model.settings.gravity.norm() / wheel.spring;
      energy += 0.5 * (wheel.spring + 4 * wheel.anti_roll) * pressed * pressed;
    }
  }
  if (level) energy += group.mass * model.settings.gravity.norm() * std::max(0.0, group.centre.z() - model.ground.height);
  return energy;
}

/// [m/s^2] greatest by its drives.
double driven(const Model& model, const ReachGroup& group) {
  double out = 0;
  for (const int b : group.bodies) {
    const Body& body = model.bodies[b];
    if (body.vehicle < 0) continue;
    const Vehicle& vehicle = model.vehicles[body.vehicle];
    double force = 0;
    for (const Schedule::Knot& knot : vehicle.drive_force.knots()) force = std::max(force, std::abs(knot.value));
    for (const DriverPhase& phase : vehicle.sequence) force += phase.drives ? std::abs(phase.force) : 0;
    out += force / body.mass;
  }
  return out;
}

void bound_motion(const Model& model, ReachGroup& group) {
  double arms = 0, reach = 0, spread = 0;
  std::vector<const Joint*> joints;
  for (const Joint& joint : model.joints)
    if (std::find(group.bodies.begin(), group.bodies.end(), joint.child) != group.bodies.end()) {
      joints.push_back(&joint);
      arms += joint.X_CF.p.norm() + (joint.parent >= 0 ? joint.X_PF.p.norm() : 0);
    }
  bool all_wait = true, all_fixed = true;
  for (const int b : group.bodies) {
    const Body& body = model.bodies[b];
    reach = std::max(reach, reach_of(model, body));
    spread = std::max(spread, (body.X_WB.p - group.centre).norm() + reach_of(model, body));
    all_wait = all_wait && waits(model, body);
    all_fixed = all_fixed && body.fixed;
  }
  group.fixed = all_fixed;
  const Vec3 velocity = all_fixed ? Vec3(Vec3::Zero()) : model.bodies[group.bodies.front()].V_WB.v;
  group.steady = (all_wait || all_fixed) && std::all_of(group.bodies.begin(), group.bodies.end(), [&](int b) {
                   const Body& body = model.bodies[b];
                   return body.vehicle < 0 && (all_fixed || (body.V_WB.v == velocity && body.V_WB.w.isZero(0)));
                 });
  if (group.steady) {
    group.velocity = velocity;
    for (const int b : group.bodies) group.boxes.push_back(box_at_start(model.bodies[b]));
  }
  group.climbs = all_wait && !velocity.isZero(0) && is_uneven(model);
  group.steady = group.steady && !group.climbs;
  group.extent = all_wait || all_fixed ? spread : arms + reach;
  if (all_fixed) return;
  if (group.climbs) {
    group.speed = kNever;
    return;
  }
  if (all_wait) {
    for (const int b : group.bodies) group.speed = std::max(group.speed, model.bodies[b].V_WB.v.norm());
    return;
  }
  const bool level = model.ground.plane && model.settings.gravity.head<2>().isZero(0);
  group.speed = is_unbounded(model, group, joints) ? kNever : std::sqrt(2 * energy_of(model, group, level) / group.mass);
  group.gain = driven(model, group) + (level ? 0 : model.settings.gravity.norm());
}

std::string name_of(const Model& model, int body) {
  const Body& of = model.bodies[body];
  return of.person >= 0 ? model.persons[of.person].name : of.name;
}

std::vector<ReachGroup> reach_groups_of(const Model& model) {
  const std::vector<int> root = join(model);
  std::vector<ReachGroup> out;
  for (int r = 0; r < static_cast<int>(root.size()); ++r) {
    if (root[r] != r) continue;
    ReachGroup group;
    group.name = name_of(model, r);
    for (int b = 0; b < static_cast<int>(root.size()); ++b)
      if (root[b] == r) {
        group.bodies.push_back(b);
        group.mass += model.bodies[b].mass;
        group.centre += model.bodies[b].mass * model.bodies[b].X_WB.p;
      }
    group.centre /= group.mass;
    bound_motion(model, group);
    out.push_back(std::move(group));
  }
  return out;
}

/// [m] between the boxes of two groups that stand.
double gap_of(const std::vector<Aabb>& a, const std::vector<Aabb>& b) {
  double least = kNever;
  for (const Aabb& p : a)
    for (const Aabb& q : b) least = std::min(least, (p.lower - q.upper).cwiseMax(q.lower - p.upper).cwiseMax(0.0).norm());
  return least;
}

/// [s] at which two groups can touch, at the earliest; infinity: not within the run. Two that wait close up only as they walk, and
/// keep their shapes: should one be touched by a third, that touch came first.
double touch_of(const ReachGroup& a, const ReachGroup& b, double duration) {
  const bool steady = a.steady && b.steady;
  const double gap = (steady ? gap_of(a.boxes, b.boxes) : (a.centre - b.centre).norm() - a.extent - b.extent) - kReachSpare;
  if (gap <= 0) return 0;
  const double closing = kFaster * (a.velocity - b.velocity).norm();
  const auto apart = [&](double t) { return (steady ? closing * t : a.way(t) + b.way(t)) < gap; };
  if (apart(duration)) return kNever;
  return math::bisect({0, duration}, math::kToTheWidth, 1e-4 * duration, apart).low;
}

bool is_simple(const Model& model, const ReachGroup& group) {
  if (group.bodies.size() == 1) return true;
  const int person = model.bodies[group.bodies.front()].person;
  return person >= 0 && std::all_of(group.bodies.begin(), group.bodies.end(),
                                    [&](int b) { return model.bodies[b].person == person && is_round(model.bodies[b]); });
}

}  // namespace

Aabb box_at_start(const Body& body) {
  if (const auto* shape = std::get_if<MeshShape>(&body.shape)) return world_bounds(*shape->mesh, body.X_WB * shape->X_BM);
  Vec3 half = Vec3::Zero();
  if (const auto* shape = std::get_if<HyperEllipsoid>(&body.shape)) half = aabb_half_widths(*shape, body.X_WB.q);
  return {body.X_WB.p - half, body.X_WB.p + half};
}

Reach reach_of(const Model& model) {
  const std::vector<ReachGroup> groups = reach_groups_of(model);
  Reach reach;
  reach.first_touch = kNever;
  for (const ReachGroup& group : groups)
    if (group.climbs) reach = {0, group.name + " and the ground"};
  for (std::size_t a = 0; a < groups.size(); ++a)
    for (std::size_t b = a + 1; b < groups.size(); ++b) {
      if (groups[a].fixed && groups[b].fixed) continue;
      const double touch = touch_of(groups[a], groups[b], model.settings.duration);
      if (!reach.who.empty() && touch >= reach.first_touch) continue;
      reach.first_touch = touch;
      reach.who = groups[a].name + " and " + groups[b].name;
    }
  reach.groups_are_simple = std::all_of(groups.begin(), groups.end(), [&](const ReachGroup& g) { return is_simple(model, g); });
  reach.all_joints_wait = std::all_of(model.joints.begin(), model.joints.end(),
                                      [&](const Joint& joint) { return waits(model, model.bodies[joint.child]); });
  const auto stays = [&](const Body& body) { return body.fixed || waits(model, body); };
  reach.all_bodies_wait = std::all_of(model.bodies.begin(), model.bodies.end(), stays);
  reach.all_rounds_wait =
      std::all_of(model.bodies.begin(), model.bodies.end(), [&](const Body& body) { return !is_round(body) || stays(body); });
  return reach;
}

}  // namespace engine
