// A panel that yields at an even pressure p bears on the part where it lies in it: on the half ahead of an ellipse of semi-axes L
// along the slip and B across, seen from in front; on a segment of a parabola, d deep and 2 B wide, seen along the slip. So
//
//   N = p (pi / 2) L B,   T = p (4 / 3) d B,   T / N = (8 / 3 pi) d / L,
//
// for a sphere of radius R and small d the 4 a / (3 pi R) of Bowden and Tabor, with a = L and d = a^2 / 2R. L is measured on the
// part: from the deepest point towards the centre until d up, where an ellipsoid's section has its centre, then half the chord
// along the slip. Straight up, along the normal, the way would leave a thin part that leans.
#include "engine/contact/ploughing.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "engine/math/roots.h"

namespace engine {
namespace {

/// Half the chord [m] of the part through `p`, inside it, along unit `direction`. The gauge is convex: from its box, outside,
/// Newton closes in from one side.
double half_chord(const HyperEllipsoid& part, const Vec3& p, const Vec3& direction) {
  constexpr int kSteps = 30;
  const double largest = 2 * part.semi_axes.norm();
  const auto way = [&](double sense) {
    double far = largest;
    for (int i = 0; i < 3; ++i)
      if (direction[i] != 0) far = std::min(far, part.semi_axes[i] / std::abs(direction[i]) - sense * p[i] / direction[i]);
    const auto beyond = [&](double s) {
      const auto [gauge, gradient] = gauge_at(part, p + sense * s * direction);
      return std::pair(gauge - 1, sense * gradient.dot(direction));
    };
    return math::newton({0, far}, far, kSteps, 0, 1e-6 * largest, beyond);
  };
  return (way(1) + way(-1)) / 2;
}

}  // namespace

double ploughing(const HyperEllipsoid& part, const Vec3& inward, const Vec3& slip, double depth) {
  constexpr double kHalf = 0.9;  // [-] of the half thickness: beyond it the part would be buried
  if (!(depth > 0)) return 0;
  const Support deepest = support(part, -inward);
  const double d = std::min(depth, kHalf * deepest.value);
  return 8 / (3 * std::numbers::pi) * d / half_chord(part, (1 - d / deepest.value) * deepest.point, slip);
}

}  // namespace engine
