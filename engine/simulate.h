// Model -> Recording. engine/README.md explains one step.
#pragma once

#include <functional>

#include "engine/meter.h"
#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

struct Plan;

/// Asked every hundred steps with the simulated time; false ends the run there (the Recording so far is kept).
using Progress = std::function<bool(double time)>;

struct RunOptions {
  Progress progress;
  Clock clock = nullptr;
};

/// Runs the model with the effects its plan calls for. Throws nothing; a divergence ends the run and stands in Recording::failure.
Recording simulate(const Model&, const Plan&, const RunOptions& = {});
Recording simulate(const Model&, const RunOptions& = {});

}  // namespace engine
