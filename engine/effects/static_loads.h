// Loads of the wheels of vehicles at rest, couplings included; on a slope too, of gravity or of a terrain, held by their brakes or
// rolling.
#pragma once

#include <vector>

#include "engine/model/model.h"
#include "engine/solver/topology.h"

namespace engine {

/// [N] per wheel, in the order of the vehicles' wheels: every body of a train is in balance (vertical force, roll and pitch
/// moments) with the loads of its wheels and what its joints carry; what that leaves open is settled by the least sum of squares. A
/// ball coupling between vehicles carries force only, every other joint moments too. Never below a hundredth of the mean: a wheel
/// that would have to pull hangs.
std::vector<double> static_wheel_loads(const Model&, const Topology&);

}  // namespace engine
