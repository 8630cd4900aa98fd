// The event of a vehicle: all phases of it that belong together, whoever struck it.
#pragma once

#include <optional>
#include <vector>

#include "engine/measure/impacts.h"

namespace engine {

/// The phase in which the other one gave a vehicle most; of one it is coupled to, which the coupling takes back, only where there
/// is no other. Its delta-v holds what a third one did meanwhile, which may be more; null where there is none.
const Impact* hardest_impact(const Model&, const std::vector<Impact>&, int vehicle);

/// What the event of its hardest phase did to a vehicle, or to one that was not struck itself that of one coupled to it, without an
/// EES; nothing where neither was struck. Phases of one vehicle that overlap, or follow within 20 ms, are one event, whoever struck
/// it (49 CFR 563.5); delta-v is the largest change of the velocity within 250 ms of it. EES is of the energy of all phases in
/// those.
std::optional<ImpactSide> hardest_event(const Model&, const Recording&, const std::vector<Impact>&, int vehicle);

}  // namespace engine
