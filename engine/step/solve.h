// The impulses of all conditions over the step, and what they do to the bodies.
#pragma once

#include "engine/step_context.h"

namespace engine {

/// Joint resistance and impulses over the step, from the smooth motion to its end: again, from the smooth motion on, where a joint
/// turned out not to be held by its friction. Sets StepContext::impulses; false when there is nothing of either.
void exchange_over_step(StepContext&);

/// Factorises the awake trees at the start of the step, without the joints' dampers.
void factor_for_impulses(StepContext&);

/// Takes the drift out of the joints; StepContext::joint_gap is what there was.
void close_joints(StepContext&);

/// Impulses of the step, by which the next solve starts.
void keep_impulses(StepContext&);

}  // namespace engine
