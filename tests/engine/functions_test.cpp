// Functions with defined bits, beside those of the C library.
#include "engine/math/functions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace engine {
namespace {

/// Within what functions.h states, and one ulp of the library's.
TEST(Functions, PowersAgreeWithTheLibrarysWhereRootsAndProductsGiveThemToo) {
  const auto close = [](double base, double exponent) {
    const double relative = 4e-16 * (1 + std::abs(exponent * std::log(std::max(base, 1e-300)))) + 2.3e-16;
    return relative * std::pow(base, exponent);
  };
  for (const double exponent : {0.4, 0.5, 2.0 / 3, 1.0, 1.5, 2.0, 2.5, 29.0})
    for (const double base : {0.0, 1e-9, 0.3, 1.0, 2.7}) {
      const Eigen::Vector2d both = math::two_powers(base, 1.3, exponent);
      EXPECT_NEAR(both[0], std::pow(base, exponent), close(base, exponent)) << base << "^" << exponent;
      EXPECT_NEAR(both[1], std::pow(1.3, exponent), close(1.3, exponent)) << exponent;
    }
}

TEST(Functions, TwoAtOnceHaveTheBitsOfOneByOne) {
  const Eigen::Vector2d angles = math::two_atan2({0.3, -2}, {-0.7, 1e-3});
  EXPECT_EQ(angles[0], math::atan2(0.3, -0.7));
  EXPECT_EQ(angles[1], math::atan2(-2, 1e-3));
  const Eigen::Vector2d powers = math::two_powers(Eigen::Vector2d(0.3, 1.9), Eigen::Vector2d(-0.4, -1.0 / 3));
  EXPECT_EQ(powers[0], math::two_powers(0.3, 1, -0.4)[0]);
  EXPECT_EQ(powers[1], math::two_powers(1.9, 1, -1.0 / 3)[0]);
}

/// Each of the two is off by an ulp, 1.1e-16 below one.
TEST(Functions, HyperbolicTangentIsOneFarOut) {
  for (const double x : {1.0, 15.0, 19.0, 19.999, 20.0, 20.001, 700.0})
    for (const double sign : {-1.0, 1.0}) EXPECT_NEAR(math::tanh(sign * x), std::tanh(sign * x), 3e-16) << sign * x;
}

}  // namespace
}  // namespace engine
