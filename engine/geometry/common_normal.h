// From a direction to the common normal of two hyper-ellipsoids: the local part of the search in hyper_ellipsoid_pair.h.
#pragma once

#include <array>

#include "engine/geometry/hyper_ellipsoid.h"

namespace engine {

/// Two hyper-ellipsoids and the signed gap of their tangent planes g(n) = n.(c_A - c_B) - h_A(n) - h_B(n), n from B to A.
struct RoundPair {
  std::array<const HyperEllipsoid*, 2> shape;
  std::array<Mat3, 2> R_WS;
  Vec3 d;  // [m] c_A - c_B, world axes

  /// All there is to know at the unit direction n.
  struct At {
    Vec3 n;
    std::array<Vec3, 2> n_S;       // in the axes of either shape
    std::array<Support, 2> reach;  // of either along n, in its axes
    double gap = 0;                // [m]
    Vec3 sum;                      // [m] of the support points, world axes
    bool closed = false;           // close_in ended here by itself: asked again it would not move
  };

  double gap(const Vec3& n) const;
  At at(const Vec3& n) const;
  /// The same where the farthest point of one shape is known better than from n, in whose digits it may be lost on a flat side.
  At at(const Vec3& n, std::size_t known, const UnscaledSupport&) const;
  Mat3 hessian(const At&, std::size_t shape) const;  // [m] of its support function, world axes
};

/// Where a climb ended.
struct CommonNormal {
  RoundPair::At at;
  bool stationary = false;  // the tangent planes are parallel there
};

/// Climbs from n towards the maximum of the gap, at most so many steps.
CommonNormal climb(const RoundPair&, const Vec3& n, int steps);

/// Newton from `at` to the common normal beside it. True if that is a maximum to rounding, no lower than where it began; else `at`
/// stays.
bool close_in(const RoundPair&, RoundPair::At& at);

/// Goes from where a climb ended to the maximum beside it, to within `tolerance` [rad] at least. Never ends below where it began.
CommonNormal settle(const RoundPair&, const CommonNormal&, double tolerance);

}  // namespace engine
