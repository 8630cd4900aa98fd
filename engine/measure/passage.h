// Vehicles pressed in deeper than vehicles are long ahead of their middle: their stiffness does not hold what they struck.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

/// When [s] the centre of mass of a vehicle got within an object that it struck. Its front is a metre and more ahead of it: from
/// there on nothing is right. Nothing where that did not happen, or surfaces do not give way.
std::optional<double> went_through(const Model&, const Recording&, int vehicle);

/// A warning for each vehicle that did.
std::vector<std::string> passages(const Model&, const Recording&);

}  // namespace engine
