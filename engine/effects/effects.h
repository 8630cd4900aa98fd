// The table of all effects, in the order of the step. Each is defined in the file of its name; adding one is that file and a line
// here.
#pragma once

#include "engine/effects/effect.h"

// clang-format off
#define CRASHREEL_EFFECTS(line)  \
  line(kZeroConditionEffect)     \
  line(kSleepEffect)             \
  line(kGravityEffect)           \
  line(kAirDragEffect)           \
  line(kJointsEffect)            \
  line(kJointLimitsEffect)       \
  line(kJointResistanceEffect)   \
  line(kJointLoopsEffect)        \
  line(kDriverEffect)            \
  line(kTyresEffect)             \
  line(kGroundContactEffect)     \
  line(kTerrainContactEffect)    \
  line(kMeshContactEffect)       \
  line(kSelfContactEffect)       \
  line(kBodyContactEffect)       \
  line(kBodyworkContactEffect)   \
  line(kKudlichSlibarEffect)
// clang-format on

namespace engine {

#define CRASHREEL_DECLARE(effect) extern const Effect effect;
CRASHREEL_EFFECTS(CRASHREEL_DECLARE)
#undef CRASHREEL_DECLARE

}  // namespace engine
