// Penetration that is there taken out at the level of positions, so that it leaves without speed.
#pragma once

#include "engine/step_context.h"

namespace engine {

/// Sets Constraint::push of an island whose impulses are known.
void correct_positions(StepContext&, const std::vector<int>& island);

}  // namespace engine
