// What has come to rest stops costing: a tree of bodies that moved less than a stated length in the last second, with everything
// near it, keeps its place until something that moves comes near again. Not neutral but bounded, so it is asked for by
// `simulation.sleep`; a minute asleep spares at most a minute of the creep it had when it fell asleep.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/effects/registration.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

constexpr double kBetweenLooks = 1;  // [s] between two looks at what has moved
constexpr double kMoved = 2e-5;      // [m] by any point of a tree in a window: still
constexpr double kNear = 0.01;       // [m] between bounding spheres
constexpr double kApproach = 0.1;    // [s] of flight ahead of which the sleeping wake

Finding look_for_sleep(const Model& model) {
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
double moved(const World& world, const State& state, const std::vector<Pose>& X_then, int tree) {
  double most = 0;
  const Topology::Tree& range = world.topology.trees[tree];
  for (int l = range.begin; l < range.end; ++l) {
    const int b = world.topology.links[l].body;
    const Pose &now = state.X_WB[b], &then = X_then[b];
    const double chord = std::min((now.q.coeffs() - then.q.coeffs()).norm(), (now.q.coeffs() + then.q.coeffs()).norm());
    most = std::max(most, (now.p - then.p).norm() + 2 * chord * world.reach[b]);
  }
  return most;
}

void wake_near(const World& world, State& state) {
  auto& asleep = state.asleep;
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

}  // namespace

/// Where all bodies were at the last look, and when the next is due.
struct SleepMemory {
  std::vector<Pose> X_then;  // per body
  double next_look = 0;      // [s]

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.X_then, s.next_look);
  }
};

class Sleep final : public EffectWith<SleepMemory> {
 public:
  static constexpr const char* kName = "sleep";
  static Finding look(const Model& model) { return look_for_sleep(model); }

  Sleep(const World& world, int self) : EffectWith(self), still_(world.topology.trees.size(), 0) {}

  void begin(World& world, State& state) override {
    if (!world.model.settings.sleep) return;
    state.asleep.assign(world.topology.trees.size(), 0);
    memory(state) = {state.X_WB, kBetweenLooks};
  }

  void before_step(World& world, State& state, double) override {
    auto& asleep = state.asleep;
    if (asleep.empty()) return;
    if (std::find(asleep.begin(), asleep.end(), 1) != asleep.end()) wake_near(world, state);
    auto& [X_then, next_look] = memory(state);
    if (state.time < next_look) return;
    next_look += kBetweenLooks;
    if (!more_to_come(world.model, state.time)) fall_asleep(world, state);
    X_then = state.X_WB;
  }

 private:
  void fall_asleep(const World& world, State& state) {
    auto& asleep = state.asleep;
    const int trees = static_cast<int>(asleep.size());
    for (int t = 0; t < trees; ++t)
      still_[t] =
          static_cast<char>(asleep[t] || (may_sleep(world, state, t) && moved(world, state, memory(state).X_then, t) < kMoved));
    for (bool any = true; any;) {  // who lies by somebody restless does not sleep
      any = false;
      for (int a = 0; a < trees; ++a) {
        if (!still_[a] || asleep[a]) continue;
        for (int b = 0; b < trees && still_[a]; ++b)
          if (!still_[b] && near(world, state, a, b)) still_[a] = 0, any = true;
      }
    }
    const double before = kinetic_energy(world.model, state);
    for (int t = 0; t < trees; ++t) {
      if (!still_[t] || asleep[t]) continue;
      asleep[t] = 1;
      const Topology::Tree& range = world.topology.trees[t];
      for (int l = range.begin; l < range.end; ++l) state.V_WB[world.topology.links[l].body] = Twist{};
    }
    state.energy.dissipated[self_] += before - kinetic_energy(world.model, state);
  }

  std::vector<char> still_;  // per tree, scratch
};
template struct Registered<Sleep>;

}  // namespace engine
