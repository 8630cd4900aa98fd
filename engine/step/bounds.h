// Bounds that several parts of the step go by.
#pragma once

#include <algorithm>

#include "engine/step_context.h"

namespace engine {

constexpr double kSlop = 2e-5;          // [m] penetration that is let be: pushing it out would make resting bodies hum
constexpr double kMayPenetrate = 9e-4;  // [m] more after a step than before: the step is halved
constexpr double kMayExceed = 7e-3;     // [rad] the same of joint limits
constexpr double kMayMislay = 10;       // [J] by which the books of an island may be off in a step: more, and it is halved
constexpr double kMayRise = 2;          // [J] that rigid contacts may give an island in a step: more, and it is halved

/// Closing speed [m/s] above which restitution acts and a touch counts as an impact; below, things come to rest.
inline double impact_speed(const StepContext& s) {
  return std::max(2 * s.world.model.settings.gravity.norm() * s.length, 0.01);
}

}  // namespace engine
