// Wheels: axle along y, outside towards +y, centred.
#pragma once

#include "assets/generate/surface.h"

namespace assets {

/// Of a car: radius, half width of the tyre and radius of the rim [m]; five double spokes.
Surface wheel(double R, double half, double rim);

/// Of a truck or bus: a dished steel rim with its nuts. Twin: two tyres, the rim deep in between them.
enum class Rim { single, twin };
Surface heavy_wheel(double R, double half, double rim, Rim kind);

std::vector<Paint> wheel_paints();

}  // namespace assets
