// Collisions of bodywork whose outcome hangs on what a rigid shell cannot tell.
#pragma once

#include <string>
#include <vector>

#include "engine/measure/impacts.h"

namespace engine {

/// How wide [m] two bodies of meshes overlap across the way on which they near each other at `point`, at the height of that point,
/// as they stand in that snapshot. Negative: they pass beside each other.
double overlap_across(const Model&, const Snapshot&, int a, int b, const Vec3& point);

/// A warning for each pair that met by Default-Auto on less than a quarter of a car's width and hooked, and for each of cars that
/// met slowly without restitution.
std::vector<std::string> doubtful_glances(const Model&, const Recording&);

}  // namespace engine
