// The effects by name, for the table. Each is defined in the file of its name.
#pragma once

#include "engine/effects/effect.h"

namespace engine {

extern const Effect kZeroConditionEffect;
extern const Effect kSleepEffect;
extern const Effect kGravityEffect;
extern const Effect kAirDragEffect;
extern const Effect kJointsEffect;
extern const Effect kJointLimitsEffect;
extern const Effect kJointResistanceEffect;
extern const Effect kJointLoopsEffect;
extern const Effect kDriverEffect;
extern const Effect kTyresEffect;
extern const Effect kGroundContactEffect;
extern const Effect kTerrainContactEffect;
extern const Effect kMeshContactEffect;
extern const Effect kSelfContactEffect;
extern const Effect kBodyContactEffect;
extern const Effect kBodyworkContactEffect;
extern const Effect kKudlichSlibarEffect;

}  // namespace engine
