// Islands: trees that conditions join are solved together, others by themselves.
#pragma once

#include "engine/step_context.h"

namespace engine {

/// Union-find by smallest tree, over the conditions of the step.
void build_islands(StepContext&);

}  // namespace engine
