// Penetration that is there taken out at the level of positions, so that it leaves without speed.
#pragma once

#include "engine/step_context.h"

namespace engine {

/// How much [m], [rad] of what a rigid contact or stop is in too deep a step of `h` [s] takes out.
double recovery(const Constraint&, double h);

/// Sets Constraint::push of an island whose impulses are known.
void correct_positions(StepContext&, const std::vector<int>& island);

}  // namespace engine
