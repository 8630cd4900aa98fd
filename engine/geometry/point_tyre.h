// A point against a tyre.
#pragma once

#include <algorithm>

#include "engine/geometry/hyper_ellipsoid_tyre.h"

namespace engine {

/// The point (a) and the surface of the tyre (b) nearest to it. A tyre is all that is within its crown of a disc: behind the disc's
/// plane the other flank is nearer.
inline SurfaceContact point_on_tyre(const Vec3& p, const Tyre& tyre) {
  const Vec3 from_hub = p - tyre.centre;
  const double along = from_hub.dot(tyre.axle);
  const Vec3 radial = from_hub - along * tyre.axle;
  const double r = radial.norm(), disc = tyre.radius - tyre.crown;
  const Vec3 core = tyre.centre + (r > disc ? disc / r : 1.0) * radial;
  const double apart = (p - core).norm();
  SurfaceContact c;
  c.p_a = p;
  c.normal = apart > 1e-9 * tyre.radius ? Vec3((p - core) / apart) : tyre.axle;
  c.p_b = core + tyre.crown * c.normal;
  c.gap = apart - tyre.crown;
  return c;
}

}  // namespace engine
