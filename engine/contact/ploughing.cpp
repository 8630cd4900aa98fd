// A panel that yields at an even pressure p bears on the part where it lies in it: on the half ahead of an ellipse of semi-axes L
// along the slip and B across, seen from in front; on a segment of a parabola, d deep and 2 B wide, seen along the slip. So
//
//   N = p (pi / 2) L B,   T = p (4 / 3) d B,   T / N = (8 / 3 pi) d / L,
//
// for a sphere of radius R and small d the 4 a / (3 pi R) of Bowden and Tabor, with a = L and d = a^2 / 2R. L is exact here: from
// the deepest point d up, then along the slip to the part's own surface.
#include "engine/contact/ploughing.h"

#include <algorithm>
#include <numbers>

#include "engine/math/roots.h"

namespace engine {
namespace {

/// From `from`, inside the part, along unit `direction` to its surface [m].
double way_to_surface(const HyperEllipsoid& part, const Vec3& from, const Vec3& direction) {
  constexpr int kHalvings = 20;  // a millionth of the part's length
  const auto is_inside = [&](double way) { return gauge(part, from + way * direction) < 1; };
  return math::bisect({0, 2 * part.semi_axes.norm()}, kHalvings, 0, is_inside).high;
}

}  // namespace

double ploughing(const HyperEllipsoid& part, const Vec3& inward, const Vec3& slip, double depth) {
  constexpr double kHalf = 0.9;  // [-] of the half thickness: beyond it the part would be buried
  if (!(depth > 0)) return 0;
  const Support deepest = support(part, -inward);
  const double d = std::min(depth, kHalf * deepest.value);
  return 8 / (3 * std::numbers::pi) * d / way_to_surface(part, deepest.point + d * inward, slip);
}

}  // namespace engine
