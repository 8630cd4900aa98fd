// Impacts with restitution (Default-Auto): when the next one happens, and the exchange of impulses at that instant.
#pragma once

#include <functional>

#include "engine/step_context.h"

namespace engine {

/// Told of impulses that have been exchanged: the conditions, the time, and over how long (0: an instant) [s].
using OnImpulses = std::function<void(const std::vector<Constraint>&, double time, double duration)>;

/// Is the touch of these surfaces an instant, with an exchange of impulses of its own? One that rebounds is, a free body's landing,
/// and the end of a joint's range. Parts of persons and vehicles that do not rebound lie down within a step: there are many.
bool is_instant(const World&, const Constraint&);

/// Between bodies by themselves, or one and what is fixed.
bool is_between_free(const World&, const Constraint&);

/// Are impacts still placed within the step? Of a chatter those beyond some number act where the bodies are.
bool places_impacts(const World&, const State&);

/// The first surfaces to touch within the step that close fast enough.
struct NextImpact {
  double time = 0;        // [s] by the speed they close at; the step's length if there are none
  std::uint64_t key = 0;  // of the contact
};
NextImpact next_impact(const StepContext&);

/// [m] from each other at which surfaces that meet exchange their impulse, at most.
constexpr double kPlaced = 1e-9;

/// Surfaces that touch and close with restitution exchange impulses, at all touching points of an island at once. False where there
/// are none.
bool exchange_impacts(StepContext&, const OnImpulses&);

}  // namespace engine
