// Disjoint sets (union-find): per member one of the same set, and the member that stands for all is its own.
#pragma once

#include <cstddef>
#include <vector>

namespace engine::math {

/// The member that stands for the set of this one; halves the way to it (Tarjan and van Leeuwen 1984).
inline int representative(std::vector<int>& set_of, int member) {
  const auto next = [&set_of](int m) -> int& { return set_of[static_cast<std::size_t>(m)]; };
  while (next(member) != member) member = next(member) = next(next(member));
  return member;
}

}  // namespace engine::math
