// The first instant of a run.
#pragma once

#include "engine/world.h"

namespace engine {

/// The state of a run that starts: bodies as the model has them, joints closed to rounding, effects begun.
State start(World&);

}  // namespace engine
