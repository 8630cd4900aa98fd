// Contact of two hyper-ellipsoids, eq. (75), (76): parallel tangent planes at least distance.
#pragma once

#include <optional>

#include "engine/geometry/hyper_ellipsoid.h"
#include "engine/geometry/surface_contact.h"

namespace engine {

/// Common normal of A and B (points from B to A) with gap < margin [m], else nothing. `normal_guess` (world, zero: none) is the
/// last step's normal and is updated to the one found even when nothing is returned; `apart` then receives a lower bound of the gap
/// [m]. Works apart (gap > 0) and overlapping.
std::optional<SurfaceContact> contact_of_pair(const HyperEllipsoid& A, const Pose& X_WA, const HyperEllipsoid& B, const Pose& X_WB,
                                              double margin, Vec3& normal_guess, double* apart = nullptr);

}  // namespace engine
