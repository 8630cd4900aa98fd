#include "engine/start.h"

#include <algorithm>

#include "engine/divergence.h"
#include "engine/effects/effect.h"
#include "engine/step/smooth_motion.h"

namespace engine {
namespace {

State initial_state(const Model& model, const Plan& plan) {
  const bool can_wait = plan.has("zero_condition");

  State state;
  state.warm.reserve(kRoom);
  state.phases.reserve(kRoom);
  state.contacts.list.reserve(kRoom);
  for (const Body& body : model.bodies) {
    state.X_WB.push_back(body.X_WB);
    state.V_WB.push_back(body.fixed ? Twist{} : body.V_WB);
  }
  for (const Person& person : model.persons) state.released.push_back(!can_wait || !person.zero_condition);
  state.broken.assign(model.joints.size(), 0);
  for (const Vehicle& vehicle : model.vehicles) state.wheel_spin.resize(state.wheel_spin.size() + vehicle.wheels.size(), 0);
  return state;
}

/// Joints closed and their velocities consistent from the first instant, to rounding: what a scene gives is good to a grid.
void close_joints(World& world, State& state) {
  std::vector<Vec6> force(state.X_WB.size(), Vec6::Zero()), result = force;
  world.active_trees.clear();
  for (int tree = 0; tree < static_cast<int>(world.topology.trees.size()); ++tree) world.active_trees.push_back(tree);
  project_joints(world, state.X_WB, state.V_WB, force, result);
}

/// Room for the memory of all pairs that the effects have listed.
void size_contact_memory(const ContactPairs& pairs, ContactMemory& memory) {
  memory.mesh.resize(pairs.mesh.size());
  memory.bodywork.resize(pairs.bodywork.size());
  for (const BodyPairRun& run : pairs.round) memory.round.emplace_back(run.pairs.size());
}

}  // namespace

State start(World& world) {
  State state = initial_state(world.model, world.plan);
  state.contacts.trees.reserve(world.topology.trees.size());
  close_joints(world, state);
  size_contact_memory(world.pairs, state.contact_memory);
  state.pace.last = world.model.settings.step;
  state.energy.dissipated.assign(world.plan.active.size(), 0);
  for (const EffectKind* effect : world.plan.active) state.memory.push_back(effect->first_memory());
  call(world, Hook::begin, &Effect::begin, world, state);
  StepBuffers buffers(world);
  const StepContext first(world, state, buffers, world.model.settings.step);  // so that suspensions know their compression at t = 0
  std::fill(state.energy.dissipated.begin(), state.energy.dissipated.end(), 0.0);
  measure_energy(world, state);
  return state;
}

}  // namespace engine
