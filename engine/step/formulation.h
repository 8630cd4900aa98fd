// What is asked of each condition over the step: target velocity, softness, and the share of the step that its impulse displaces
// over. Rigid contacts and stops, compliant contacts, compliant stops; wheels and closed loops bring their own.
#pragma once

#include "engine/step_context.h"

namespace engine {

/// Conditions that cannot close within the step are let go.
void drop_open_conditions(StepContext&);

/// Friction that changes with time or place: its mean over the step, along the way of each contact.
void take_mean_friction(StepContext&);

void formulate(StepContext&);

/// Springs at rest that something strikes within the step leave the steep part of their law, whose slope they were told to follow.
/// True where the island of this tree has any and its impulses are to be found again. So is what parted and is pressed again: it
/// rests.
bool wake_struck_springs(StepContext&, int root);

/// A spring that turns its contact within the step gives back no more than its share from there on: without this the force of the
/// approach would go on to the end of the step, and that of rest for one more, and throw off by S depth step / mass what ought to
/// stay. True where any was held and the impulses are to be found again.
bool hold_spent_springs(StepContext&, int root);

}  // namespace engine
