// Equal to the last bit, also in the sign of a zero: what was computed from one is what would be from the other.
#pragma once

#include <cstring>

#include "engine/math/types.h"

namespace engine {

inline bool same_bits(const Quat& a, const Quat& b) {
  return std::memcmp(a.coeffs().data(), b.coeffs().data(), 4 * sizeof(double)) == 0;
}

inline bool same_bits(const Pose& a, const Pose& b) {
  return same_bits(a.q, b.q) && std::memcmp(a.p.data(), b.p.data(), 3 * sizeof(double)) == 0;
}

}  // namespace engine
