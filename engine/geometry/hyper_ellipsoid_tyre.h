// Contact of a hyper-ellipsoid (a) with a tyre (b): how far the wheel must be moved for the two just to touch.
#pragma once

#include <optional>

#include "engine/geometry/hyper_ellipsoid.h"
#include "engine/geometry/surface_contact.h"

namespace engine {

/// A tyre: a disc rounded at its rim, the convex hull of a torus. What reaches into the hole of the torus is met by the rim's wall.
struct Tyre {
  Vec3 centre = Vec3::Zero();  // [m] world
  Vec3 axle = Vec3::UnitY();   // unit, world
  double radius = 0.3;         // [m] outer
  double crown = 0.1;          // [m] of the rounding, no more than the radius
};

/// Where a tyre that is moved along a direction comes to touch.
struct TyreTouch {
  double way = 0;               // [m] to move it by; negative: it may come back by so much
  Vec3 point = Vec3::Zero();    // [m] world, of the two surfaces once it has been moved
  Vec3 normal = Vec3::UnitZ();  // unit, from the hyper-ellipsoid to the tyre
};

/// The least way [m] along `along` (unit) by which the tyre is clear of the shape on that side. Nothing where they pass each other
/// by with a normal steeper than `facing`, the cosine between it and the direction. `least` [m]: a way below it need not be told.
/// Source: over normals m with m.along = 1 the way h_T(m) + h_A(m) - m.(c_T - c_A) of the two support functions is convex; its
/// minimum is where the line through the tyre's centre leaves the Minkowski sum of both.
std::optional<TyreTouch> move_clear(const Tyre&, const HyperEllipsoid&, const Pose& X_WA, const Vec3& along, double facing,
                                    double least);

/// The point at which the two are nearest, or deepest in each other, normal from tyre to shape; nothing from `margin` [m] on.
std::optional<SurfaceContact> contact_with_tyre(const HyperEllipsoid&, const Pose& X_WA, const Tyre&, double margin);

}  // namespace engine
