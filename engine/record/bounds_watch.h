// Watches how far contacts and joints fall short of the bounds they promise to keep.
#pragma once

#include <string>
#include <vector>

#include "engine/world.h"

namespace engine {

class BoundsWatch {
 public:
  /// A condition just solved; `duration` [s] of its step, 0 for an instantaneous exchange.
  void watch(const World&, const Constraint&, double time, double duration);

  /// At the end of the run: the deepest compression, and warnings.
  void close(const World&, Diagnostics&) const;

 private:
  void watch_compression(const Constraint&, double time, double duration);

  double compression_ = 0;  // [m] deepest of a compliant contact
  Shortfall too_deep_;      // [m] of a compliant contact, beyond its thickness
  Shortfall stood_inside_;  // [m] of a rigid contact
  Shortfall crossed_;       // [m] of two vehicles
  Shortfall overturned_;    // [rad] of a joint, beyond its range
  Shortfall overslid_;      // [m] the same of a slide
};

}  // namespace engine
