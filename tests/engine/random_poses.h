// Directions and attitudes spread evenly, and the exponents that tests of shapes go through.
#pragma once

#include <random>

#include "engine/math/types.h"

namespace engine::test {

constexpr double kFromEllipsoidToBox[] = {2, 2.01, 2.5, 3, 4, 7.3, 15, 29.97, 30};

inline Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

inline Quat random_attitude(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Quat(normal(random), normal(random), normal(random), normal(random)).normalized();
}

}  // namespace engine::test
