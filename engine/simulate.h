// Model -> Recording. engine/README.md explains one step.
#pragma once

#include <functional>

#include "engine/meter.h"
#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

struct Plan;
struct State;

/// Asked every hundred steps with the simulated time; false ends the run there (the Recording so far is kept).
using Progress = std::function<bool(double time)>;

struct RunOptions {
  Progress progress;
  Clock clock = nullptr;   // for the costs
  StepClocks step_clocks;  // for Recording::longest_step
  /// Goes on from here in place of the model's start, to the end of the model's duration. Of the same model and plan, at the end of
  /// a step, such as `end` of an earlier run; counted in the run's own frame (local_frame.h). The Recording then begins at its time
  /// and tells what happens from there on; energies count from the start of the first run.
  const State* from = nullptr;
  /// Gets the state at the end of the run. With a Progress that says when, a run can be stopped anywhere.
  State* end = nullptr;
};

/// Runs the model with the effects its plan calls for. Throws nothing; a divergence ends the run and stands in Recording::failure.
Recording simulate(const Model&, const Plan&, const RunOptions& = {});
Recording simulate(const Model&, const RunOptions& = {});

}  // namespace engine
