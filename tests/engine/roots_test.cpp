// The root finders against roots known in closed form, and what they promise of their brackets.
#include "engine/math/roots.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace {

using namespace engine::math;

TEST(Roots, HalvingKeepsTheChangeInsideAndCountsItsHalvings) {
  int asked = 0;
  const Bracket b = bisect({0, 2}, 20, 0, [&](double x) { return ++asked, x * x < 2; });
  EXPECT_EQ(asked, 20);
  EXPECT_EQ(b.width(), std::ldexp(2.0, -20));
  EXPECT_LE(b.low, std::sqrt(2.0));
  EXPECT_GE(b.high, std::sqrt(2.0));
}

TEST(Roots, HalvingEndsAtTheWidthOrWhereThereIsNoNumberBetween) {
  EXPECT_LE(bisect({0, 2}, kToTheWidth, 1e-3, [](double x) { return x < 1.2345; }).width(), 1e-3);
  const Bracket neighbours = bisect({0, 2}, kToTheWidth, 0, [](double x) { return x < 1.2345; });
  EXPECT_EQ(std::nextafter(neighbours.low, 2), neighbours.high);
  EXPECT_EQ(neighbours.high, 1.2345);
}

TEST(Roots, RegulaFalsiClosesInFromBothEnds) {
  // one end of x^10 - 0.5 would stay for ever without Illinois' half
  int asked = 0;
  const auto f = [&](double x) { return ++asked, std::pow(x, 10) - 0.5; };
  const Bracket b = illinois({0, 2}, -0.5, 1023.5, 60, 1e-12, f, [](double v) { return v == 0; });
  EXPECT_NEAR(b.low, std::pow(0.5, 0.1), 1e-11);
  EXPECT_LE(b.width(), 1e-12);
  EXPECT_LT(asked, 40);  // halving alone takes 41
}

TEST(Roots, RegulaFalsiEndsWhereItIsMetAndTakesNoNumberForLow) {
  const Bracket met = illinois(
      {0, 2}, -1, 1, 60, 0, [](double x) { return x - 1; }, [](double v) { return std::abs(v) < 1e-9; });
  EXPECT_EQ(met.low, met.high);
  EXPECT_NEAR(met.low, 1, 1e-9);
  const Bracket half = illinois(
      {0, 2}, -1, 1, 60, 1e-9, [](double x) { return x < 1.5 ? std::nan("") : 1.0; }, [](double) { return false; });
  EXPECT_NEAR(half.high, 1.5, 2e-9);
}

TEST(Roots, NewtonStaysInItsBracket) {
  // from 0.9 a plain step on atan(10 (x - 0.1)) would leave to -1.6 and never come back
  double least = 1, most = 0;
  const double x = newton({0, 1}, 0.9, 40, 1e-13, 1e-14, [&](double at) {
    least = std::min(least, at), most = std::max(most, at);
    const double u = 10 * (at - 0.1);
    return std::pair(std::atan(u), 10 / (1 + u * u));
  });
  EXPECT_NEAR(x, 0.1, 1e-12);
  EXPECT_GE(least, 0);
  EXPECT_LE(most, 1);
  // over the root of sqrt(|x - 0.3|) sign(x - 0.3) + 0.003 a plain step goes to the other side, as far away
  EXPECT_NEAR(newton({0, 1}, 0.6, 60, 1e-12, 0,
                     [](double at) {
                       const double root = std::sqrt(std::abs(at - 0.3));
                       return std::pair(std::copysign(root, at - 0.3) + 0.003, 0.5 / root);
                     }),
              0.3 - 9e-6, 1e-7);
  // without a slope it halves
  EXPECT_NEAR(newton({0, 1}, 0.5, 60, 1e-12, 0, [](double at) { return std::pair(at - 0.3, 0.0); }), 0.3, 1e-11);
}

}  // namespace
