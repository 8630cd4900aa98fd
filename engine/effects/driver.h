// What the driver asks of the wheels: pedals by the clock, the wheel angle by a path.
#pragma once

#include "engine/world.h"

namespace engine {

/// Brake force [N] asked of a wheel now: pedal and sequence.
double brake_of(const Vehicle&, int wheel, double time);

/// Engine force [N] at a wheel now.
double drive_of(const Vehicle&, int wheel, double time);

/// Pure pursuit: the circle through the middle of the unsteered wheels, along the vehicle's axis, that meets the path a preview
/// ahead. Behind the end of the path the last segment goes on.
void steer_along_path(World&, const State&, int vehicle);

}  // namespace engine
