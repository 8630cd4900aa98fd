// Watches how far contacts and joints fall short of the bounds they promise to keep.
#pragma once

#include <string>
#include <vector>

#include "engine/world.h"

namespace engine {

class BoundsWatch {
 public:
  BoundsWatch() { presses_.reserve(kRoom); }

  /// A condition just solved; `duration` [s] of its step, 0 for an instantaneous exchange.
  void watch(const World&, const Constraint&, double time, double duration);

  /// All conditions of that step: who is pressed from two sides.
  void watch_squeezes(const World&, const std::vector<Constraint>&, double time);

  /// At the end of the run: the deepest compression, and warnings.
  void close(const World&, Diagnostics&) const;

 private:
  void watch_compression(const Constraint&, double time, double duration);

  /// What presses a person's part, seen from the part.
  struct Press {
    int part = -1, by = -1;
    Vec3 normal = Vec3::Zero();  // unit, into the part
    double depth = 0;            // [m] of both surfaces
    double own = 0;              // [m] of it, by which the part gives way
    double thickness = 0;        // [m] of the part
    bool by_itself = false;      // by a part of the same person
  };
  struct Squeeze {
    double time = 0;
    Press one, other;
    double excess() const;  // [-] above one the part gives way by more than it can
  };
  void note_press(const Model&, const Constraint&, int part, int by);

  double compression_ = 0;      // [m] deepest of a compliant contact
  Shortfall too_deep_;          // [m] of a compliant contact, beyond its thickness
  std::vector<Press> presses_;  // of the step at hand; room is kept from step to step
  Squeeze squeezed_;            // hardest of a part between two sides
  Shortfall stood_inside_;      // [m] of a rigid contact
  Shortfall crossed_;           // [m] of two vehicles
  Shortfall overturned_;        // [rad] of a joint, beyond its range
  Shortfall overslid_;          // [m] the same of a slide
};

}  // namespace engine
