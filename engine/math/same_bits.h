// Equal to the last bit, also in the sign of a zero: what was computed from one is what would be from the other.
#pragma once

#include <bit>
#include <cstdint>

#include "engine/math/types.h"

namespace engine {

/// Of `n` doubles. Most that differ do so in the first; memcmp would be a call.
template <int n>
inline bool same_bits(const double* a, const double* b) {
  const auto differ = [&](int i) { return std::bit_cast<std::uint64_t>(a[i]) ^ std::bit_cast<std::uint64_t>(b[i]); };
  if (differ(0) != 0) return false;
  std::uint64_t any = 0;
  for (int i = 1; i < n; ++i) any |= differ(i);
  return any == 0;
}

inline bool same_bits(const Quat& a, const Quat& b) {
  return same_bits<4>(a.coeffs().data(), b.coeffs().data());
}

inline bool same_bits(const Pose& a, const Pose& b) {
  return same_bits(a.q, b.q) && same_bits<3>(a.p.data(), b.p.data());
}

}  // namespace engine
