// Which effects a model calls for, and why. Compiled once before the run.
#pragma once

#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

struct Effect;

/// Every known effect has a line; `active` holds those that run, in the order of the step.
struct Plan {
  std::vector<PlanLine> lines;
  std::vector<const Effect*> active;
};

Plan compile(const Model&);

}  // namespace engine
