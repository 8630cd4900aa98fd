#include "engine/simulate.h"

#include <algorithm>
#include <cmath>

#include "engine/divergence.h"
#include "engine/effects/effect.h"
#include "engine/local_frame.h"
#include "engine/record/recorder.h"
#include "engine/start.h"
#include "engine/step/step.h"
#include "engine/step_watch.h"

namespace engine {
namespace {

constexpr int kAskEvery = 100;  // steps between two calls of the caller's progress

void describe(const Model& model, const Plan& plan, Recording& recording) {
  for (const Body& body : model.bodies) recording.body_names.push_back(body.name);
  for (const Vehicle& vehicle : model.vehicles) recording.vehicle_names.push_back(vehicle.name);
  for (const EffectKind* effect : plan.active) recording.effect_names.push_back(effect->name);
  recording.plan = plan.lines;
}

void note_actions(RunLog& log, const std::vector<Constraint>& conditions, double time) {
  for (const Constraint& c : conditions)
    if (!c.impulse.isZero(0)) log.note_action(c.effect, time);
}

/// What the run saw of its effects, to the lines of the plan.
void tell_actions(const RunLog& log, std::vector<PlanLine>& lines) {
  auto acted = log.acted.begin();
  for (PlanLine& line : lines)
    if (line.active) line.acted = *acted++;
}

Recording run(const Model& model, const Plan& plan, const RunOptions& options) {
  Recording recording;
  describe(model, plan, recording);
  World world(model, plan, options);
  State state = options.from ? *options.from : start(world);

  const double h = model.settings.step;
  // a step told to nine digits divides the duration all the same
  const double parts = model.settings.duration / h;
  const long first = std::lround(state.time / h), steps = std::lround(std::ceil(parts - 1e-9 * std::max(parts, 1.0)));
  const long per_snapshot = std::max(1L, std::lround(model.settings.record_interval / h));
  recording.interval = static_cast<double>(per_snapshot) * h;
  Recorder recorder(world, state);
  recorder.snapshot(world, state, recording);
  Stepper stepper(world, [&](const std::vector<Constraint>& conditions, double time, double duration) {
    const Meter::Span span(world.meter, Phase::recording);
    recorder.tally(world, conditions, time, duration);
    note_actions(world.log, conditions, time);
  });
  StepWatch watch(options.step_clocks);
  // at such a speed the first step alone would take minutes
  recording.failure = look_for_divergence(world, state, stepper.conditions());
  for (long k = first; k < steps && !recording.failure; ++k) {
    double left = h;
    while (left > 1e-9 * h && !recording.failure) {
      left -= stepper.advance(state, left);
      recording.failure = look_for_divergence(world, state, stepper.conditions());
      if (left > 1e-9 * h) recorder.follow(world, state, left, recording);
    }
    watch.note(world, state, stepper.conditions());
    if (recording.failure) break;
    state.time = static_cast<double>(k + 1) * h;
    ++recording.steps;
    const Meter::Span span(world.meter, Phase::recording);
    recorder.sample(world, state, recording);
    if ((k + 1) % per_snapshot == 0 || k + 1 == steps) {
      recorder.snapshot(world, state, recording);
      if (model.settings.stop_at_rest && recorder.all_at_rest(world, state, recording)) break;
    }
    if (options.progress && (k + 1) % kAskEvery == 0 && !options.progress(state.time)) break;
  }
  recorder.finish(world, state, recording);
  tell_actions(world.log, recording.plan);
  recording.longest_step = watch.longest(world);
  world.meter.finish();
  recording.costs = world.meter.effects;
  recording.phases = world.meter.phases;
  if (options.end) *options.end = std::move(state);
  return recording;
}

void tell_what_is_left_out(const Model& model, Recording& recording) {
  for (const EffectKind* effect : effect_table())
    for (PlanLine& line : recording.plan)
      if (effect->left_out && line.effect == effect->name && !line.forced_off()) {
        const LeftOut left_out = effect->left_out(model, recording, line.active);
        if (!left_out.text.empty()) line.left_out = left_out.text;
        if (left_out.matters) recording.diagnostics.warnings.push_back(line.effect + ": " + left_out.text);
      }
  for (const PlanLine& line : recording.plan)
    if (line.idle()) recording.diagnostics.warnings.push_back(line.effect + " was " + line.reason);
}

}  // namespace

Recording simulate(const Model& model, const Plan& plan, const RunOptions& options) {
  const auto forced = model.settings.effects.find("gravity");
  if (forced != model.settings.effects.end() && forced->second == Force::off && !model.settings.gravity.isZero(0)) {
    Model weightless = model;  // in loads, energies and bounds too
    weightless.settings.gravity.setZero();
    return simulate(weightless, plan, options);
  }
  const LocalFrame frame(model);
  Recording recording = run(frame.inwards(model), plan, options);
  frame.outwards(model, recording);
  tell_what_is_left_out(model, recording);
  return recording;
}

Recording simulate(const Model& model, const RunOptions& options) {
  return simulate(model, compile(model), options);
}

}  // namespace engine
