// A tyre on the triangles of a mesh: over a kerb, a step, from slope to slope.
#pragma once

#include <optional>
#include <vector>

#include "engine/geometry/hyper_ellipsoid_tyre.h"
#include "engine/geometry/triangle_mesh.h"

namespace engine {

/// Ways [m] that count: more than the least, no more than the most. What would need more is met from the side.
struct WayRange {
  double least = 0, most = 0;
};

/// Where a tyre that is moved along `along` (unit, square to its axle) stands on the mesh: the way of a rigid disc of its outer
/// radius over what its middle plane cuts of the triangles, `facing` as for hyper-ellipsoids. On a face the normal is the face's,
/// on an edge it points at the hub. Nothing where no way in `range` leads there. Source: the disc's centre follows the highest of
/// the curves z + sqrt(R^2 - s^2) over the profile z(s); each is concave along a straight piece and has its top at an end or where
/// the piece is tangent to the disc.
std::optional<TyreTouch> move_clear(const Tyre&, const TriangleMesh&, const Pose& X_WM, const Vec3& along, double facing,
                                    const WayRange& range, std::vector<int>& scratch);

}  // namespace engine
