// The accelerations of heads, and the peaks of all bodies, step by step.
#pragma once

#include <vector>

#include "engine/world.h"

namespace engine {

/// Only where persons yield: a rigid blow has no acceleration.
class Accelerometers {
 public:
  /// Heads, at the end of every part of a divided step but the last; `left` [s] of it.
  void follow(const World&, const State&, double left, Recording&);

  /// Heads and peaks, at the end of every step.
  void sample(const World&, const State&, Recording&);

  /// Noughts for who was still, at the end of the run.
  void finish(const World&, Recording&) const;

 private:
  void begin(const World&, Recording&);

  std::vector<Vec3> velocity_;       // [m/s] per body, at the last step
  std::vector<Vec3> head_velocity_;  // [m/s] per person, at the last of the times
  std::vector<double> times_;        // [s] of the heads' samples
  double stepped_ = 0;               // [s] when the last step ended
  long listed_ = -1;                 // StillBodies::changes when a body's step was noted last
};

}  // namespace engine
