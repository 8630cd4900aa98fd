// What every contact-geometry function returns: where two surfaces touch or nearly touch.
#pragma once

#include <cstdint>

#include "engine/geometry/small_vector.h"
#include "engine/math/types.h"

namespace engine {

/// One point of (near) contact between shape a and shape b, world frame.
struct SurfaceContact {
  Vec3 p_a = Vec3::Zero();      // [m] the surface point of a
  Vec3 p_b = Vec3::Zero();      // [m] the surface point of b
  Vec3 normal = Vec3::UnitZ();  // unit, points from b to a
  double gap = 0;               // [m] (p_a - p_b).normal; negative = penetration depth
  std::uint32_t key = 0;        // names the feature (quadrant, triangle cluster ...) so that warm starts find it again
  double share_across = 0.5;    // where flat sides leave p_a and p_b aside of each other: share of that way the contact lies at
  bool rolls = false;           // a wheel of a on its tread: no friction
  double lifted = 0;            // [m] a corner of a flat side that carries for its deepest point: how far it stands above that
};

/// Up to this many points describe one pair of shapes (a flat face on a plane needs four and its deepest point).
constexpr int kMaxContactsPerPair = 6;
using ContactPoints = SmallVector<SurfaceContact, kMaxContactsPerPair>;

}  // namespace engine
