// Which effects a model calls for, and why. Compiled once before the run.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

struct EffectKind;

/// Every known effect has a line; `active` holds those that run, in the order of the step.
struct Plan {
  std::vector<PlanLine> lines;
  std::vector<const EffectKind*> active;
  /// What the run is integrated by: rk4 that finds nothing for its stages is stepping, to the last bit.
  Scheme integrated_by = Scheme::stepping;
  std::vector<std::string> once_a_step;  // what rk4 or adaptive leave to one solve a step, as stepping does

  bool has(std::string_view effect) const {
    return std::any_of(lines.begin(), lines.end(), [effect](const PlanLine& l) { return l.active && l.effect == effect; });
  }
};

Plan compile(const Model&);

}  // namespace engine
