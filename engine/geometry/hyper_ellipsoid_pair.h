// Contact of two hyper-ellipsoids, eq. (75), (76): parallel tangent planes at least distance.
#pragma once

#include <limits>
#include <optional>
#include <tuple>

#include "engine/geometry/hyper_ellipsoid.h"
#include "engine/geometry/surface_contact.h"

namespace engine {

/// How near to zero the gap comes at any other common normal of two bodies deep in each other, seen with B at `X_AB` in the frame
/// of A. As long as neither has moved enough to make another the shallower one, there is no need to look for it again.
struct OtherNormals {
  double gap = std::numeric_limits<double>::infinity();  // [m] no other is above it; infinite: not looked for
  Pose X_AB;

  /// An upper bound of it now that B stands at X_AB_now. Its points lie within `reach` of its centre [m].
  double by_now(const Pose& X_AB_now, double reach) const;

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.gap, s.X_AB);
  }
};

/// Common normal of A and B (points from B to A) with gap < margin [m], else nothing. `normal_guess` (world, zero: none) is the
/// last step's normal and is updated to the one found even when nothing is returned; `apart` then receives a lower bound of the gap
/// [m]. `others`, where given, spares what is deep the search for a better normal than the guess leads to; without it every call
/// searches. Works apart (gap > 0) and overlapping.
std::optional<SurfaceContact> contact_of_pair(const HyperEllipsoid& A, const Pose& X_WA, const HyperEllipsoid& B, const Pose& X_WB,
                                              double margin, Vec3& normal_guess, double* apart = nullptr,
                                              OtherNormals* others = nullptr);

}  // namespace engine
