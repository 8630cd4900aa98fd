// Smooth curves through given points: the lines a body is drawn with.
#pragma once

#include <array>
#include <vector>

namespace assets {

using Curve = std::vector<std::array<double, 2>>;  // abscissa ascending, value

/// Smooth curve through points: Fritsch-Carlson monotone cubic, so that it never overshoots; constant beyond both ends.
double through(const Curve&, double x);

}  // namespace assets
