// What is asked of each condition over the step: target velocity, softness, and the share of the step that its impulse displaces
// over. Rigid contacts and stops, compliant contacts, compliant stops; wheels and closed loops bring their own.
#pragma once

#include "engine/step_context.h"

namespace engine {

/// Conditions that cannot close within the step are let go.
void drop_open_conditions(StepContext&);

void formulate(StepContext&);

}  // namespace engine
