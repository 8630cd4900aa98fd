// The accelerations of heads, and the peaks of all bodies, step by step.
#pragma once

#include <vector>

#include "engine/world.h"

namespace engine {

/// Only where persons yield: a rigid blow has no acceleration.
class Accelerometers {
 public:
  /// At the end of every step.
  void sample(const World&, const State&, Recording&);

  /// Noughts for who was still, at the end of the run.
  void finish(const World&, Recording&) const;

 private:
  void begin(const World&, Recording&);
  void list_moving(const World&);

  std::vector<Vec3> velocity_;  // [m/s] per body, at the last sample
  double sampled_ = 0;          // [s] when that was
  std::vector<double> times_;   // [s] of the samples
  std::vector<int> moving_;     // persons who are not still
  long listed_ = -1;            // StillBodies::changes when those were listed
};

}  // namespace engine
