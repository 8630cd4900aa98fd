// What has come to rest stops costing: a tree of bodies that moved less than a stated length in the last second, with everything
// near it, keeps its place until something that moves comes near again. Not neutral but bounded, so it is asked for by
// `simulation.sleep`; a minute asleep spares at most a minute of the creep it had when it fell asleep.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/effects/effects.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

constexpr double kWindow = 1;      // [s] between two looks at what has moved
constexpr double kMoved = 2e-5;    // [m] by any point of a tree in a window: still
constexpr double kNear = 0.01;     // [m] between bounding spheres
constexpr double kApproach = 0.1;  // [s] of flight ahead of which the sleeping wake

Finding look(const Model& model) {
  if (!model.settings.sleep) return {false, "simulation.sleep is false", ""};
  return {true, "what moves less than 0.02 mm in a second, with all that is near it, keeps its place",
          "at most 0.02 mm of creep a second; contact forces of what sleeps are not recorded"};
}

/// Something the author lets happen by the clock after `now`: nothing sleeps before that.
bool more_to_come(const Model& model, double now) {
  auto changes = [now](const Schedule& s) { return s.knots().size() > 1 && s.knots().back().time > now; };
  if (changes(model.ground.surface.friction_ground)) return true;
  for (const GroundPatch& patch : model.ground.patches)
    if (changes(patch.friction)) return true;
  for (const Body& body : model.bodies)
    if (changes(body.surface.friction_body) || changes(body.surface.friction_ground)) return true;
  for (const Vehicle& vehicle : model.vehicles) {
    if (changes(vehicle.brake) || changes(vehicle.drive_force) || changes(vehicle.steer)) return true;
    for (const DriverPhase& phase : vehicle.sequence)
      if (phase.first_force + phase.build_up > now || (std::isfinite(phase.until) && phase.until > now)) return true;
  }
  return false;
}

/// Sphere about a tree's root.
struct Bounds {
  Vec3 centre = Vec3::Zero();  // [m]
  double radius = 0;           // [m]
  double speed = 0;            // [m/s] of its fastest point, at most
};

Bounds bounds_of(const World& world, const State& state, int tree) {
  const Topology::Tree& range = world.topology.trees[tree];
  Bounds bounds{state.X_WB[world.topology.links[range.begin].body].p, 0, 0};
  for (int l = range.begin; l < range.end; ++l) {
    const int b = world.topology.links[l].body;
    bounds.radius = std::max(bounds.radius, (state.X_WB[b].p - bounds.centre).norm() + world.reach[b]);
    bounds.speed = std::max(bounds.speed, state.V_WB[b].v.norm() + world.reach[b] * state.V_WB[b].w.norm());
  }
  return bounds;
}

bool near(const World& world, const State& state, int a, int b) {
  for (const Joint& joint : world.model.joints) {
    if (joint.parent < 0) continue;
    const int p = world.topology.tree_of_body[joint.parent], c = world.topology.tree_of_body[joint.child];
    if ((p == a && c == b) || (p == b && c == a)) return true;
  }
  const Bounds A = bounds_of(world, state, a), B = bounds_of(world, state, b);
  return (A.centre - B.centre).norm() < A.radius + B.radius + kNear + kApproach * (A.speed + B.speed);
}

bool may_sleep(const World& world, const State& state, int tree) {
  const int person = world.topology.trees[tree].person;
  return person < 0 || state.released[person];  // who waits in the zero condition is spared already
}

/// Largest way [m] of any point of the tree since the last look.
double moved(const World& world, const State& state, int tree) {
  double most = 0;
  const Topology::Tree& range = world.topology.trees[tree];
  for (int l = range.begin; l < range.end; ++l) {
    const int b = world.topology.links[l].body;
    const Pose &now = state.X_WB[b], &then = world.sleep.X_then[b];
    const double chord = std::min((now.q.coeffs() - then.q.coeffs()).norm(), (now.q.coeffs() + then.q.coeffs()).norm());
    most = std::max(most, (now.p - then.p).norm() + 2 * chord * world.reach[b]);
  }
  return most;
}

void begin(World& world, const State& state, int) {
  if (!world.model.settings.sleep) return;
  world.sleep.asleep.assign(world.topology.trees.size(), 0);
  world.sleep.still.assign(world.topology.trees.size(), 0);
  world.sleep.X_then = state.X_WB;
  world.sleep.next_look = kWindow;
}

void wake_near(World& world, const State& state) {
  auto& asleep = world.sleep.asleep;
  const int trees = static_cast<int>(asleep.size());
  for (bool any = true; any;) {
    any = false;
    for (int a = 0; a < trees; ++a) {
      if (!asleep[a]) continue;
      for (int b = 0; b < trees && asleep[a]; ++b)
        if (!asleep[b] && near(world, state, a, b)) asleep[a] = 0, any = true;
    }
  }
}

void fall_asleep(World& world, State& state, int self) {
  auto& [asleep, still, X_then, next_look] = world.sleep;
  const int trees = static_cast<int>(asleep.size());
  for (int t = 0; t < trees; ++t)
    still[t] = static_cast<char>(asleep[t] || (may_sleep(world, state, t) && moved(world, state, t) < kMoved));
  for (bool any = true; any;) {  // who lies by somebody restless does not sleep
    any = false;
    for (int a = 0; a < trees; ++a) {
      if (!still[a] || asleep[a]) continue;
      for (int b = 0; b < trees && still[a]; ++b)
        if (!still[b] && near(world, state, a, b)) still[a] = 0, any = true;
    }
  }
  const double before = kinetic_energy(world.model, state);
  for (int t = 0; t < trees; ++t) {
    if (!still[t] || asleep[t]) continue;
    asleep[t] = 1;
    const Topology::Tree& range = world.topology.trees[t];
    for (int l = range.begin; l < range.end; ++l) state.V_WB[world.topology.links[l].body] = Twist{};
  }
  world.dissipated[self] += before - kinetic_energy(world.model, state);
  X_then = state.X_WB;
}

void before_step(World& world, State& state, int self) {
  auto& asleep = world.sleep.asleep;
  if (asleep.empty()) return;
  if (std::find(asleep.begin(), asleep.end(), 1) != asleep.end()) wake_near(world, state);
  if (state.time < world.sleep.next_look) return;
  world.sleep.next_look += kWindow;
  if (more_to_come(world.model, state.time)) {
    world.sleep.X_then = state.X_WB;
    return;
  }
  fall_asleep(world, state, self);
}

}  // namespace

const Effect kSleepEffect{.name = "sleep", .look = look, .begin = begin, .before_step = before_step};

}  // namespace engine
