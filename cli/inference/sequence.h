// Points that fill a cube evenly: Sobol's sequence, scrambled after Owen.
#pragma once

#include <cstdint>
#include <vector>

namespace cli::inference {

/// Points `from` .. `from + count` - 1 of the sequence in (0, 1)^dimensions. The same seed gives the same points, whatever part of
/// them is asked for.
///
/// Sobol's points by Boost; then every digit is swapped or not by a coin that depends on the digits before it (A. B. Owen, 1995):
/// each point is uniform in the cube, and the even filling stays.
std::vector<std::vector<double>> scrambled_points(int dimensions, std::uint64_t from, std::uint64_t count, std::uint64_t seed);

/// 64 bits without pattern from a number: the coin above.
std::uint64_t mixed(std::uint64_t);

}  // namespace cli::inference
