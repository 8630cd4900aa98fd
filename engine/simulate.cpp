#include "engine/simulate.h"

#include <algorithm>
#include <cmath>

#include "engine/divergence.h"
#include "engine/effects/effects.h"
#include "engine/local_frame.h"
#include "engine/recorder.h"
#include "engine/step.h"

namespace engine {
namespace {

constexpr int kAskEvery = 100;  // steps between two calls of the caller's progress

State initial_state(const Model& model, const Plan& plan) {
  const bool can_wait = std::find(plan.active.begin(), plan.active.end(), &kZeroConditionEffect) != plan.active.end();

  State state;
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

void describe(const Model& model, const Plan& plan, Recording& recording) {
  for (const Body& body : model.bodies) recording.body_names.push_back(body.name);
  for (const Vehicle& vehicle : model.vehicles) recording.vehicle_names.push_back(vehicle.name);
  for (const Effect* effect : plan.active) recording.effect_names.push_back(effect->name);
  recording.plan = plan.lines;
}

Recording run(const Model& model, const Plan& plan, const RunOptions& options) {
  Recording recording;
  describe(model, plan, recording);
  World world(model, plan, options);
  State state = initial_state(model, plan);
  close_joints(world, state);
  world.step = model.settings.step;
  world.dissipated.assign(plan.active.size(), 0);
  call(world, &Effect::begin, state);
  call(world, &Effect::find, state);  // once, so that suspensions know their compression at t = 0
  world.constraints.clear();
  std::fill(world.dissipated.begin(), world.dissipated.end(), 0.0);

  const double h = model.settings.step;
  const long steps = std::lround(std::ceil(model.settings.duration / h - 1e-9));
  const long per_snapshot = std::max(1L, std::lround(model.settings.record_interval / h));
  recording.interval = static_cast<double>(per_snapshot) * h;
  Recorder recorder(world, state);
  recorder.snapshot(world, state, recording);
  const DivergenceWatch watch(world, state);
  Stepper stepper(world);
  stepper.on_impulses = [&](double time, double duration) {
    const Meter::Span span(world.meter, Phase::recording);
    recorder.tally(world, time, duration);
  };
  for (long k = 0; k < steps; ++k) {
    double left = h;
    while (left > 1e-9 * h && !recording.failure) {
      left -= stepper.advance(world, state, left);
      recording.failure = watch.look(world, state);
    }
    if (recording.failure) break;
    state.time = static_cast<double>(k + 1) * h;
    ++recording.steps;
    const Meter::Span span(world.meter, Phase::recording);
    recorder.sample(world, state, recording);
    if ((k + 1) % per_snapshot == 0 || k + 1 == steps) {
      recorder.snapshot(world, state, recording);
      if (model.settings.stop_at_rest && recorder.all_at_rest(world, state)) break;
    }
    if (options.progress && (k + 1) % kAskEvery == 0 && !options.progress(state.time)) break;
  }
  recorder.finish(world, state, recording);
  world.meter.finish();
  recording.costs = world.meter.effects;
  recording.phases = world.meter.phases;
  return recording;
}

}  // namespace

Recording simulate(const Model& model, const Plan& plan, const RunOptions& options) {
  const LocalFrame frame(model);
  Recording recording = run(frame.inwards(model), plan, options);
  frame.outwards(model, recording);
  return recording;
}

Recording simulate(const Model& model, const RunOptions& options) {
  return simulate(model, compile(model), options);
}

}  // namespace engine
