#include "engine/start.h"

#include <algorithm>
#include <string>

#include "engine/divergence.h"
#include "engine/effects/effect.h"
#include "engine/effects/words.h"
#include "engine/joints/rows.h"
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
  project_joints(world, state.X_WB, state.V_WB, force, result, false);
}

/// The part of given velocities that a joint forbids.
struct Forbidden {
  int joint = -1;
  double speed = 0;  // [m/s] of the child's point against the parent's
  double turn = 0;   // [rad/s] of the child against the parent
};

Forbidden forbidden_by(const Model& model, int j, const State& given) {
  const Joint& joint = model.joints[static_cast<std::size_t>(j)];
  const bool to_world = joint.parent < 0;
  JointRows rows;
  joint_rows(joint, to_world ? Pose{} : given.X_WB[joint.parent], given.X_WB[joint.child], rows);
  joint_velocity_error(to_world ? kStill : given.V_WB[joint.parent], given.V_WB[joint.child], rows);
  return {j, rows.bias.head(rows.held_along).norm(), rows.bias.segment(rows.held_along, rows.held_turns()).norm()};
}

/// Closing the joints takes out what they forbid, with its energy. A scene that gave it did not mean the run that follows.
void warn_of_forbidden_velocities(World& world, const State& given, const State& closed) {
  constexpr double kToldSpeed = 0.01, kToldTurn = 0.05;  // [m/s], [rad/s] places good to a millimetre that turn at 10 rad/s
  const Model& model = world.model;
  Forbidden worst;
  std::size_t count = 0;
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const Forbidden now = forbidden_by(model, j, given);
    if (now.speed <= kToldSpeed && now.turn <= kToldTurn) continue;
    ++count;
    if (std::max(now.speed / kToldSpeed, now.turn / kToldTurn) > std::max(worst.speed / kToldSpeed, worst.turn / kToldTurn))
      worst = now;
  }
  if (count == 0) return;
  const Joint& joint = model.joints[static_cast<std::size_t>(worst.joint)];
  const auto change = [&](int b) { return b < 0 ? 0 : (closed.V_WB[b].v - given.V_WB[b].v).norm(); };
  const int body = change(joint.parent) > change(joint.child) ? joint.parent : joint.child;
  const double lost = kinetic_energy(model, given) - kinetic_energy(model, closed);
  const std::string name = joint.name.empty() ? "its joint" : "joint " + joint.name;
  const bool slides = worst.speed > kToldSpeed;
  world.log.diagnostics.warnings.push_back(model.bodies[body].name + " starts with a velocity that " + name + " forbids, " +
                                           (slides ? number(worst.speed) + " m/s at its point" : number(worst.turn) + " rad/s") +
                                           (count > 1 ? ", and " + counted(count - 1, "more joint") + " likewise" : "") +
                                           ": it was taken out, with " + number(lost) + " J; " + model.bodies[body].name +
                                           " starts at " + number(closed.V_WB[body].v.norm()) + " m/s in place of " +
                                           number(given.V_WB[body].v.norm()) + " m/s");
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
  const State given = state;
  close_joints(world, state);
  warn_of_forbidden_velocities(world, given, state);
  size_contact_memory(world.pairs, state.contact_memory);
  state.pace.last = world.model.settings.step;
  state.pace.heads.resize(world.model.persons.size());
  state.pace.in_vain.resize(world.topology.trees.size());
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
