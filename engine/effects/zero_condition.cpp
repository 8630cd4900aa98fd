// Until the first external impact gravity and joint forces of a person balance: it keeps its pose, stands or walks on as one, and
// costs a bounding test a step. The first touch by anything but its support releases it (source 000, "zero condition").
#include <algorithm>

#include "engine/effects/body_pairs.h"
#include "engine/effects/bodywork_contact.h"
#include "engine/effects/effects.h"
#include "engine/effects/words.h"
#include "engine/geometry/hyper_ellipsoid_pair.h"

namespace engine {
namespace {

Finding look(const Model& model) {
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
  world.events.push_back({state.time, "release", body, by, point, 0});
}

/// Would the two close their gap within this step?
bool touches(const World& world, const State& state, const SurfaceContact& touch, int a, int b) {
  auto velocity_at = [&](int body) -> Vec3 {
    if (body < 0) return Vec3::Zero();
    return state.V_WB[body].v + state.V_WB[body].w.cross(touch.p_a - state.X_WB[body].p);
  };
  const double closing = -touch.normal.dot(velocity_at(a) - velocity_at(b));
  return touch.gap - closing * world.step <= 0 && closing > 0;
}

/// A mount struck by another mesh sets its rider free.
void watch_mounts(World& world, State& state) {
  for (std::size_t p = 0; p < world.model.persons.size(); ++p) {
    const int mount = world.model.persons[p].mount;
    if (mount < 0 || state.released[p]) continue;
    for (int other = 0; other < static_cast<int>(world.model.bodies.size()); ++other) {
      if (other == mount || world.model.bodies[other].person == static_cast<int>(p)) continue;
      for (const SurfaceContact& touch : contacts_of_meshes(world, state, mount, other))
        if (!state.released[p] && touches(world, state, touch, mount, other)) release(world, state, mount, other, touch.p_a);
    }
  }
}

/// Vehicles and other meshes.
void watch_meshes(World& world, State& state, bool warn) {
  ContactPoints found;
  for (MeshPair& pair : world.mesh_pairs) {
    if (pair.mesh_body < 0 || !waits(world, state, pair.body)) continue;
    if (world.model.bodies[pair.mesh_body].person == world.model.bodies[pair.body].person) continue;  // what it rides
    const auto& mesh = std::get<MeshShape>(world.model.bodies[pair.mesh_body].shape);
    const Pose X_WM = state.X_WB[pair.mesh_body] * mesh.X_BM;
    const Pose X_MA = X_WM.inverse() * state.X_WB[pair.body];
    const double margin = pair_margin(world, state, pair.body, pair.mesh_body), reach = world.reach[pair.body];
    if (pair.clearance.beyond(margin, X_MA, reach)) continue;
    contacts_with_mesh(std::get<HyperEllipsoid>(world.model.bodies[pair.body].shape), state.X_WB[pair.body], *pair.mesh, X_WM,
                       margin, pair.clearance.by_now(X_MA, reach), world.mesh_scratch, found);
    pair.clearance.note(world.mesh_scratch.apart, X_MA, reach);
    for (const SurfaceContact& touch : found)
      if (touches(world, state, touch, pair.body, pair.mesh_body)) release(world, state, pair.body, pair.mesh_body, touch.p_a);
    if (warn && waits(world, state, pair.body))
      for (const SurfaceContact& touch : found) warn_of_overlap(world, pair.body, pair.mesh_body, touch.gap);
  }
}

void watch_pair(World& world, State& state, const BodyPair& pair, Vec3& normal_W, bool warn) {
  const Body &A = world.model.bodies[pair.a], &B = world.model.bodies[pair.b];
  if (A.person >= 0 && A.person == B.person) return;
  if (!waits(world, state, pair.a) && !waits(world, state, pair.b)) return;
  const std::optional<double> margin = margin_of_near(world, state, pair);
  if (!margin) return;
  const auto touch = contact_of_pair(std::get<HyperEllipsoid>(A.shape), state.X_WB[pair.a], std::get<HyperEllipsoid>(B.shape),
                                     state.X_WB[pair.b], *margin, normal_W);
  if (!touch) return;
  if (!touches(world, state, *touch, pair.a, pair.b)) {
    if (warn) warn_of_overlap(world, pair.a, pair.b, touch->gap);
    return;
  }
  if (waits(world, state, pair.a)) release(world, state, pair.a, pair.b, touch->p_a);
  if (waits(world, state, pair.b)) release(world, state, pair.b, pair.a, touch->p_b);
}

void before_step(World& world, State& state, int) {
  if (std::all_of(state.released.begin(), state.released.end(), [](char r) { return r != 0; })) return;
  const bool warn = state.time == 0 && world.model.settings.contact_law != ContactLaw::compliant;
  watch_mounts(world, state);
  watch_meshes(world, state, warn);
  world.nearness.look(world, state);
  for (BodyPairRun& run : world.body_pair_runs) {
    if (!world.nearness.close(run.tree_a, run.tree_b)) continue;
    list_pairs(world, run);
    for (std::size_t i = 0; i < run.pairs.size(); ++i) watch_pair(world, state, run.pairs[i], run.memory[i].normal_W, warn);
  }
}

/// Walks on as one.
void after_step(World& world, State& state, int) {
  for (std::size_t p = 0; p < world.model.persons.size(); ++p) {
    if (state.released[p]) continue;
    for (const int b : world.model.persons[p].bodies) {
      if (world.awake[b]) continue;
      state.X_WB[b].p += world.step * state.V_WB[b].v;
    }
    if (const int mount = world.model.persons[p].mount; mount >= 0 && !world.awake[mount])
      state.X_WB[mount].p += world.step * state.V_WB[mount].v;
  }
}

}  // namespace

const Effect kZeroConditionEffect{.name = "zero_condition", .look = look, .before_step = before_step, .after_step = after_step};

}  // namespace engine
