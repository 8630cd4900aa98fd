// Notes the step that took longest to compute. It only looks: what it measures goes nowhere near the state.
#pragma once

#include <array>

#include "engine/world.h"

namespace engine {

class StepWatch {
 public:
  explicit StepWatch(const StepClocks& clocks);

  /// A step has ended here, with these conditions.
  void note(const World&, const State&, const std::vector<Constraint>&);

  /// Nothing without clocks.
  std::optional<LongestStep> longest(const World&) const;

 private:
  StepClocks clocks_;
  double step_began_ = 0;  // [s] by `passed`
  double span_began_ = 0;  // [s] by `passed`, when `computed` was read last
  double computed_ = 0;    // [s] then
  double longest_ = 0;     // [s]
  double time_ = 0;        // [s] simulated, of the longest
  std::array<int, 3> bodies_{-1, -1, -1};
};

}  // namespace engine
