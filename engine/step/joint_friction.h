// Springs, dampers and dry friction of the joints over a step, linearly implicit.
#pragma once

#include "engine/step_context.h"

namespace engine {

/// Asks the effects for dampers and torques over the step.
void prepare_resistance(StepContext&);

/// Acts on the end of the smooth motion; the trees are factorised with the dampers in them.
void apply_resistance(StepContext&);

/// After the impulses: how fast the joints turn now.
void note_motion_after(StepContext&);

/// Did a joint come out faster than its friction was told of? Then its damper is revised.
bool friction_gave_way(StepContext&);

/// Work [J] of a joint's resistance over the step on the two bodies it joins, once the velocities at its end are known.
double resistance_work(const StepContext&, int joint);

}  // namespace engine
