#include "engine/math/functions.h"

#include <sleef.h>

#include <cmath>
#include <limits>

// SLEEF's `cinz` functions give the same bits in vectors of any length and without vectors. On x86-64 two lanes of SSE2 are there
// always, and two to three times faster than the plain ones.
#ifdef __SSE2__
#define CRASHREEL_OF_ONE(name, x) _mm_cvtsd_f64(Sleef_cinz_##name##d2_u10sse2(_mm_set_sd(x)))
#define CRASHREEL_OF_TWO(name, x, y) _mm_cvtsd_f64(Sleef_cinz_##name##d2_u10sse2(_mm_set_sd(x), _mm_set_sd(y)))
#else
#define CRASHREEL_OF_ONE(name, x) Sleef_cinz_##name##d1_u10purec(x)
#define CRASHREEL_OF_TWO(name, x, y) Sleef_cinz_##name##d1_u10purec(x, y)
#endif

namespace engine::math {

double sin(double x) {
  return CRASHREEL_OF_ONE(sin, x);
}
double cos(double x) {
  return CRASHREEL_OF_ONE(cos, x);
}
double tan(double x) {
  return CRASHREEL_OF_ONE(tan, x);
}
double acos(double x) {
  return CRASHREEL_OF_ONE(acos, x);
}
double atan(double x) {
  return CRASHREEL_OF_ONE(atan, x);
}
double atan2(double y, double x) {
  return CRASHREEL_OF_TWO(atan2, y, x);
}
Eigen::Vector2d two_atan2(const Eigen::Vector2d& y, const Eigen::Vector2d& x) {
#ifdef __SSE2__
  const __m128d angles = Sleef_cinz_atan2d2_u10sse2(_mm_set_pd(y[1], y[0]), _mm_set_pd(x[1], x[0]));
  return {_mm_cvtsd_f64(angles), _mm_cvtsd_f64(_mm_unpackhi_pd(angles, angles))};
#else
  return {atan2(y[0], x[0]), atan2(y[1], x[1])};
#endif
}
double exp(double x) {
  return CRASHREEL_OF_ONE(exp, x);
}
double pow(double x, double y) {
  return CRASHREEL_OF_TWO(pow, x, y);
}
double tanh(double x) {
  constexpr double kOne = 20;  // beyond it the result is 1 to the last bit
  return std::abs(x) > kOne ? std::copysign(1.0, x) : CRASHREEL_OF_ONE(tanh, x);
}
double tgamma(double x) {
  return CRASHREEL_OF_ONE(tgamma, x);
}
double lgamma(double x) {
  return CRASHREEL_OF_ONE(lgamma, x);
}

double hypot(double x, double y) {
  return std::sqrt(x * x + y * y);
}

Eigen::Vector2d two_powers(const Eigen::Vector2d& bases, const Eigen::Vector2d& exponents) {
#ifdef __SSE2__
  const __m128d logarithms = Sleef_cinz_logd2_u35sse2(_mm_set_pd(bases[1], bases[0]));
  const __m128d powers = Sleef_cinz_expd2_u10sse2(_mm_mul_pd(_mm_set_pd(exponents[1], exponents[0]), logarithms));
  return {_mm_cvtsd_f64(powers), _mm_cvtsd_f64(_mm_unpackhi_pd(powers, powers))};
#else
  return {Sleef_cinz_expd1_u10purec(exponents[0] * Sleef_cinz_logd1_u35purec(bases[0])),
          Sleef_cinz_expd1_u10purec(exponents[1] * Sleef_cinz_logd1_u35purec(bases[1]))};
#endif
}

Quat rotation(double angle, const Vec3& axis) {
  const Vec3 v = sin(0.5 * angle) * axis;
  return {cos(0.5 * angle), v.x(), v.y(), v.z()};
}

Quat slerp(const Quat& a, const Quat& b, double s) {
  const double cosine = a.dot(b), nearest = std::abs(cosine);
  double of_a = 1 - s, of_b = s;
  if (nearest < 1 - std::numeric_limits<double>::epsilon()) {
    const double angle = acos(nearest), sine = sin(angle);
    of_a = sin(of_a * angle) / sine;
    of_b = sin(of_b * angle) / sine;
  }
  return Quat((of_a * a.coeffs() + (cosine < 0 ? -of_b : of_b) * b.coeffs()).eval());
}

double angle_between(const Quat& a, const Quat& b) {
  const Quat turn = a * b.conjugate();
  return 2 * atan2(turn.vec().norm(), std::abs(turn.w()));
}

}  // namespace engine::math
