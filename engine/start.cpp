#include "engine/start.h"

#include <algorithm>

#include "engine/effects/effects.h"
#include "engine/solver/smooth_motion.h"

namespace engine {
namespace {

State initial_state(const Model& model, const Plan& plan) {
  const bool can_wait = std::find(plan.active.begin(), plan.active.end(), &kZeroConditionEffect) != plan.active.end();

  State state;
  state.warm.reserve(kRoom);
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

}  // namespace

State start(World& world) {
  State state = initial_state(world.model, world.plan);
  close_joints(world, state);
  world.step = world.model.settings.step;
  world.dissipated.assign(world.plan.active.size(), 0);
  call(world, &Effect::begin, state);
  call(world, &Effect::find, state);  // once, so that suspensions know their compression at t = 0
  world.constraints.clear();
  std::fill(world.dissipated.begin(), world.dissipated.end(), 0.0);
  return state;
}

}  // namespace engine
