// Friction that changes within a step, with the time or the place: its mean over the step. Taken at the step's start it would be of
// first order only: an edge or a knot crossed within a step moves the result by up to what a whole step does.
#pragma once

#include "engine/model/model.h"

namespace engine {

/// A point on its way over a step.
struct StepWay {
  Vec3 from = Vec3::Zero();      // [m] world
  Vec3 velocity = Vec3::Zero();  // [m/s]
  double time = 0, length = 0;   // [s]
};

/// [-] of a coefficient alone, of which only the time of the way counts.
double mean_friction(const Schedule&, const StepWay&);
/// [-] of the ground alone.
double mean_friction(const Ground&, const StepWay&);
/// [-] of a body on it: the smaller of both at any time.
double mean_friction(const Body&, const Ground&, const StepWay&);
/// [-] of two bodies, of which only the time of the way counts.
double mean_friction(const Body&, const Body&, const StepWay&);

/// Does any friction of the model change?
bool friction_varies(const Model&);

}  // namespace engine
