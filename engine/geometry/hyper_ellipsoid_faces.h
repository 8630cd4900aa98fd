// Contact of two hyper-ellipsoids that lie on each other with flat sides: a patch of points, so that the load spreads over it.
#pragma once

#include "engine/geometry/hyper_ellipsoid.h"
#include "engine/geometry/surface_contact.h"

namespace engine {

/// What two flat-sided hyper-ellipsoids are to each other.
enum class FacesMeet {
  apart,  // farther than the margin
  flat,   // side on side: the patch is all of the contact
  other   // by edges, corners, or aside of each other: the deepest point tells
};

/// Points with gap < margin [m] between two sides that lie on each other, or nearly; `out` is cleared first. Normals point from B
/// to A, keys name the corners. `apart` receives a lower bound of the gap [m] where they are apart. Of `other` nothing is found.
/// Only from exponent 8 on are sides flat enough.
FacesMeet contacts_of_faces(const HyperEllipsoid& A, const Pose& X_WA, const HyperEllipsoid& B, const Pose& X_WB, double margin,
                            ContactPoints& out, double& apart);

}  // namespace engine
