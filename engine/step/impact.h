// Impacts with restitution (Default-Auto): when the next one happens, and the exchange of impulses at that instant.
#pragma once

#include <functional>

#include "engine/step_context.h"

namespace engine {

/// Told of impulses that have been exchanged: the conditions, the time, and over how long (0: an instant) [s].
using OnImpulses = std::function<void(const std::vector<Constraint>&, double time, double duration)>;

/// Time [s] until the first surfaces touch that close fast enough to rebound; the step's length if none do within it.
double time_to_impact(const StepContext&);

/// Surfaces that touch and close with restitution exchange impulses, at all touching points of an island at once. False where there
/// are none.
bool exchange_impacts(StepContext&, const OnImpulses&);

}  // namespace engine
