// What the driver asks of the pedals, by the clock.
#pragma once

#include "engine/world.h"

namespace engine {

/// Brake force [N] asked of a wheel now: pedal and sequence. `carried`: its share of the load, for BrakeBalance::loads.
double brake_of(const Vehicle&, int wheel, double time, double carried);

/// Engine force [N] at a wheel now.
double drive_of(const Vehicle&, int wheel, double time);

}  // namespace engine
