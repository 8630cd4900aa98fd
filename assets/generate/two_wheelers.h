// Bicycle and motorcycle of tubes and rounded bodies, made to the library's riders.
#pragma once

#include "assets/generate/surface.h"

namespace assets {

/// Without wheels; origin on the ground midway between the axles. Saddle, bars and pedals where the pose `cyclist` has them.
Surface bicycle();
/// The same for the pose `motorcyclist`.
Surface motorcycle();
/// Wheel of radius r [m], tyre of thickness t: axle along y, centred.
Surface spoked_wheel(double r, double t, int spokes);

std::vector<Paint> two_wheeler_paints();

}  // namespace assets
