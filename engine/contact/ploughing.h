// What a panel resists a part with that is pressed into it and slides along: the wall of its own dent stands in the way.
#pragma once

#include "engine/geometry/hyper_ellipsoid.h"

namespace engine {

/// Tangential over normal force [-] of a rigid `part` pressed `depth` [m] into sheet metal or broken glass and moved along it.
/// `inward`: unit normal of the panel's front, from panel to part; `slip`: unit, at right angles to it; both in the part's axes.
/// What is dented does not come back, so only the half ahead bears. Zero for no depth.
/// Source: F. P. Bowden and D. Tabor, The Friction and Lubrication of Solids, 1950, chapter 5: it adds to the friction of surfaces.
double ploughing(const HyperEllipsoid& part, const Vec3& inward, const Vec3& slip, double depth);

}  // namespace engine
