// Transcendental functions with defined results: the same bits on every processor, C library and compiler. The system's own take
// another variant where there is fused multiply-add, and a hit person then ends decimetres off. Sums, products, quotients and roots
// are exact to the last bit by IEEE 754 and need no such care. Arguments in rad; errors as SLEEF states them: 1 ulp unless said.
#pragma once

#include "engine/math/types.h"

namespace engine::math {

double sin(double);
double cos(double);
double tan(double);
double acos(double);
double atan(double);
double atan2(double y, double x);
/// Two at once in the time of one, with the bits of one by one.
Eigen::Vector2d two_atan2(const Eigen::Vector2d& y, const Eigen::Vector2d& x);
double exp(double);
double pow(double base, double exponent);
double tanh(double);
double tgamma(double);
double lgamma(double);

/// Length of (x, y), by an exact root: below 1e150, as all lengths and speeds here.
double hypot(double x, double y);

/// base^exponent of two bases >= 0 at once, several times faster than `pow`: exp(exponent ln base), the logarithm to 3.5 ulp.
/// Relative error below 4e-16 (1 + |exponent ln base|); of a base in 0..1 and a positive exponent the absolute error stays below
/// 4e-16.
Eigen::Vector2d two_powers(const Eigen::Vector2d& bases, const Eigen::Vector2d& exponents);

/// The same with one exponent: those of n = 2, 2.5 and 3, which products and roots give, take no logarithm.
inline Eigen::Vector2d two_powers(double base_1, double base_2, double exponent) {
  const Eigen::Vector2d bases(base_1, base_2);
  if (exponent == 1) return bases;
  if (exponent == 2) return bases.cwiseAbs2();
  if (exponent == 0.5) return bases.cwiseSqrt();
  if (exponent == 1.5) return bases.cwiseProduct(bases.cwiseSqrt());
  return two_powers(bases, {exponent, exponent});
}

/// Turn by `angle` [rad] about a unit axis.
Quat rotation(double angle, const Vec3& axis);

/// The attitude a share s in 0..1 of the way from a to b, at a steady rate along the shorter way.
Quat slerp(const Quat& a, const Quat& b, double s);

/// Angle [rad] between two attitudes, 0..pi.
double angle_between(const Quat& a, const Quat& b);

}  // namespace engine::math
