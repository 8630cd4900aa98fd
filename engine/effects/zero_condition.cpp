// Until the first external impact gravity and joint forces of a person balance: it keeps its pose, stands or walks on as one, and
// costs a bounding test a step. The first touch by anything but its support releases it (source 000, "zero condition").
#include <algorithm>

#include "engine/contact/tyre_pairs.h"
#include "engine/effects/body_pairs.h"
#include "engine/effects/bodywork_contact.h"
#include "engine/effects/registration.h"
#include "engine/effects/riding.h"
#include "engine/effects/words.h"
#include "engine/geometry/hyper_ellipsoid_pair.h"

namespace engine {
namespace {

Finding look_at(const Model& model) {
  std::vector<std::string> waiting;
  for (const Person& person : model.persons)
    if (person.zero_condition) waiting.push_back(person.name);
  if (model.persons.empty()) return {false, "no person", ""};
  if (waiting.empty()) return {false, "zero_condition = false for " + counted(model.persons.size(), "person"), ""};
  const std::string keep = waiting.size() == 1 ? " keeps pose and speed" : " keep pose and speed";
  return {true, listed(waiting) + keep + " until something other than the support touches",
          "until then gravity, joints and support, which are taken to be in balance"};
}

bool waits(const World& world, const State& state, int body) {
  const int person = world.model.bodies[body].person;
  return person >= 0 && !state.released[person];
}

void release(World& world, State& state, int body, int by, const Vec3& point) {
  const int person = world.model.bodies[body].person;
  if (state.released[person]) return;
  state.released[person] = 1;
  world.log.events.push_back({state.time, "release", body, by, point, 0});
}

/// Would the two close their gap within this step?
bool touches(const Outlook& outlook, const SurfaceContact& touch, int a, int b) {
  auto velocity_at = [&](int body) -> Vec3 {
    if (body < 0) return Vec3::Zero();
    return outlook.at.V_WB[body].v + outlook.at.V_WB[body].w.cross(touch.p_a - outlook.at.X_WB[body].p);
  };
  const double closing = -touch.normal.dot(velocity_at(a) - velocity_at(b));
  return touch.gap - closing * outlook.within <= 0 && closing > 0;
}

/// A mount struck by another mesh sets its rider free.
void watch_mounts(const Outlook& outlook) {
  World& world = outlook.world;
  State& state = outlook.state;
  for (std::size_t p = 0; p < world.model.persons.size(); ++p) {
    const int mount = world.model.persons[p].mount;
    if (mount < 0 || state.released[p]) continue;
    for (int other = 0; other < static_cast<int>(world.model.bodies.size()); ++other) {
      if (other == mount || world.model.bodies[other].person == static_cast<int>(p)) continue;
      for (const SurfaceContact& touch : contacts_of_meshes(outlook, mount, other))
        if (!state.released[p] && touches(outlook, touch, mount, other)) release(world, state, mount, other, touch.p_a);
    }
  }
}

/// Vehicles and other meshes.
void watch_meshes(const Outlook& outlook, bool warn) {
  World& world = outlook.world;
  State& state = outlook.state;
  ContactPoints found;
  for (std::size_t i = 0; i < world.pairs.mesh.size(); ++i) {
    const MeshPair& pair = world.pairs.mesh[i];
    // a mount that runs into somebody: both are set free, and its rider
    if (pair.mesh_body < 0 || (!waits(world, state, pair.body) && !waits(world, state, pair.mesh_body))) continue;
    if (world.model.bodies[pair.mesh_body].person == world.model.bodies[pair.body].person) continue;  // what it rides
    const auto& mesh = std::get<MeshShape>(world.model.bodies[pair.mesh_body].shape);
    const Pose X_WM = state.X_WB[pair.mesh_body] * mesh.X_BM;
    const Pose X_MA = X_WM.inverse() * state.X_WB[pair.body];
    const double margin = pair_margin(outlook, pair.body, pair.mesh_body), reach = world.reach[pair.body];
    Clearance& clearance = state.contact_memory.mesh[i];
    if (clearance.beyond(margin, X_MA, reach)) continue;
    contacts_with_mesh(std::get<HyperEllipsoid>(world.model.bodies[pair.body].shape), state.X_WB[pair.body], *pair.mesh, X_WM,
                       margin, clearance.by_now(X_MA, reach), world.pairs.mesh_scratch, found);
    clearance.note(world.pairs.mesh_scratch.apart, X_MA, reach);
    for (const SurfaceContact& touch : found) {
      if (!touches(outlook, touch, pair.body, pair.mesh_body)) continue;
      if (waits(world, state, pair.body)) release(world, state, pair.body, pair.mesh_body, touch.p_a);
      if (waits(world, state, pair.mesh_body)) release(world, state, pair.mesh_body, pair.body, touch.p_b);
    }
    if (warn && waits(world, state, pair.body))
      for (const SurfaceContact& touch : found) warn_of_overlap(world, pair.body, pair.mesh_body, touch.gap);
  }
}

/// Wheels that roll up to somebody.
void watch_tyres(const Outlook& outlook) {
  World& world = outlook.world;
  State& state = outlook.state;
  if (state.wheels.empty()) return;
  for (const TyrePair& pair : world.pairs.tyres) {
    if (!waits(world, state, pair.body) && !waits(world, state, pair.vehicle_body)) continue;
    const double margin = pair_margin(outlook, pair.body, pair.vehicle_body);
    if (!near(outlook, pair, margin)) continue;
    const auto touch = beside_tyre(outlook, pair, margin);
    if (!touch || !touches(outlook, *touch, pair.body, pair.vehicle_body)) continue;
    if (waits(world, state, pair.body)) release(world, state, pair.body, pair.vehicle_body, touch->p_a);
    if (waits(world, state, pair.vehicle_body)) release(world, state, pair.vehicle_body, pair.body, touch->p_b);
  }
}

void watch_pair(const Outlook& outlook, const BodyPair& pair, Vec3& normal_W, bool warn) {
  World& world = outlook.world;
  State& state = outlook.state;
  const Body &A = world.model.bodies[pair.a], &B = world.model.bodies[pair.b];
  if (A.person >= 0 && A.person == B.person) return;
  if (!waits(world, state, pair.a) && !waits(world, state, pair.b)) return;
  const std::optional<double> margin = margin_of_near(outlook, pair);
  if (!margin) return;
  const auto touch = contact_of_pair(std::get<HyperEllipsoid>(A.shape), state.X_WB[pair.a], std::get<HyperEllipsoid>(B.shape),
                                     state.X_WB[pair.b], *margin, normal_W);
  if (!touch) return;
  if (!touches(outlook, *touch, pair.a, pair.b)) {
    if (warn) warn_of_overlap(world, pair.a, pair.b, touch->gap);
    return;
  }
  if (waits(world, state, pair.a)) release(world, state, pair.a, pair.b, touch->p_a);
  if (waits(world, state, pair.b)) release(world, state, pair.b, pair.a, touch->p_b);
}

}  // namespace

class ZeroCondition final : public Effect {
 public:
  static constexpr const char* kName = "zero_condition";
  static Finding look(const Model& model) { return look_at(model); }

  ZeroCondition(const World&, int self) : Effect(self) {}

  void before_step(World& world, State& state, double step) override {
    if (std::all_of(state.released.begin(), state.released.end(), [](char r) { return r != 0; })) return;
    const bool warn = state.time == 0 && !yields(world.model.settings.contact_law, true);
    const Outlook outlook{world, state, state, step};
    watch_mounts(outlook);
    watch_meshes(outlook, warn);
    watch_tyres(outlook);
    ContactPairs& pairs = world.pairs;
    pairs.broad_phase.look(outlook);
    for (std::size_t r = 0; r < pairs.round.size(); ++r) {
      const BodyPairRun& run = pairs.round[r];
      if (!pairs.broad_phase.close(run.tree_a, run.tree_b)) continue;
      std::vector<PairMemory>& memory = state.contact_memory.round[r];
      list_pairs(world, r, memory);
      for (std::size_t i = 0; i < run.pairs.size(); ++i) watch_pair(outlook, run.pairs[i], memory[i].normal_W, warn);
    }
  }

  /// Walks, or rides, on as one.
  void after_step(StepContext& step) override {
    const World& world = step.world;
    State& state = step.state;
    for (std::size_t p = 0; p < world.model.persons.size(); ++p) {
      if (state.released[p]) continue;
      const int mount = world.model.persons[p].mount;
      if (mount >= 0 && !world.awake[mount]) {
        ride(step, static_cast<int>(p), self_);
        continue;
      }
      for (const int b : world.model.persons[p].bodies) {
        if (world.awake[b]) continue;
        state.X_WB[b].p += step.length * state.V_WB[b].v;
      }
    }
  }
};
template struct Registered<ZeroCondition>;

}  // namespace engine
