// Contact of a hyper-ellipsoid (a) with a plane (b), eq. (70), (71): closed form by the support function.
#pragma once

#include "engine/geometry/hyper_ellipsoid.h"
#include "engine/geometry/surface_contact.h"

namespace engine {

/// Plane: normal.x = offset, `normal` unit (world), outside where normal.x > offset. Points with gap < margin [m] go to `out`
/// (cleared first). For n < 4 the one deepest point; for n >= 4 also up to four points around it, so that a nearly flat face
/// rests on its corners instead of on a point that jumps (a tilt of 1e-6 rad moves the n = 30 support point by 0.6 half widths).
void contacts_with_plane(const HyperEllipsoid&, const Pose& X_WA, const Vec3& normal, double offset, double margin,
                         ContactPoints& out);

}  // namespace engine
