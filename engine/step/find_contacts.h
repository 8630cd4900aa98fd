// Collision detection over all effects of the plan.
#pragma once

#include "engine/step_context.h"

namespace engine {

/// Contacts and limits where bodies are `at`, that a step of the model's length could close, in the order of the plan. `before`:
/// those of the last step's end.
void find_contacts(World&, State&, const Motion& at, const std::vector<Constraint>& before, std::vector<Constraint>& found);

/// Contacts alone, that could close `within` a time [s]; for the stages of Runge and Kutta. Of a motion gone astray: none.
void find_stage_contacts(World&, State&, const Motion& at, double within, std::vector<Constraint>& found);

}  // namespace engine
