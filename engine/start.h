// The first instant of a run.
#pragma once

#include "engine/world.h"

namespace engine {

/// Bodies as the model has them, joints closed to rounding, effects begun; the world is then ready for its first step.
State start(World&);

}  // namespace engine
