// Everything is scaled by its largest term before a power is taken, so that n = 30 neither over- nor underflows.
#include "engine/geometry/hyper_ellipsoid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "engine/math/functions.h"

namespace engine {
namespace {

/// Curvature radii are infinite on the flat faces of n > 2; capped at this many times the size they do no harm to Newton's method.
constexpr double kLargestRadius = 1e3;

/// base^exponent of three bases >= 0. One of them is mostly 1, where all are shares of the largest.
Vec3 powers(const Vec3& bases, double exponent) {
  if (exponent == 1) return bases;
  if (exponent == 2) return bases.cwiseAbs2();
  if (exponent == 0.5) return bases.cwiseSqrt();
  if (exponent == 1.5) return bases.cwiseProduct(bases.cwiseSqrt());
  const int alone = bases[0] == 1 ? 0 : bases[1] == 1 ? 1 : 2;
  const int i = (alone + 1) % 3, j = (alone + 2) % 3;
  const Eigen::Vector2d two = math::two_powers(bases[i], bases[j], exponent);
  Vec3 out;
  out[i] = two[0];
  out[j] = two[1];
  out[alone] = bases[alone] == 1 ? 1 : math::two_powers(bases[alone], 1, exponent)[0];
  return out;
}

/// (sum (w_i)^p)^(1/p) for w >= 0.
double norm_p(const Vec3& w, double p) {
  if (p == 2) return w.norm();
  const double largest = w.maxCoeff();
  if (largest == 0) return 0;
  return largest * math::two_powers(powers(w / largest, p).sum(), 1, 1 / p)[0];
}

double cube(double x) {
  return x * x * x;
}

/// Integral of x^2 over the body per a^2 and volume: k(2) = 1/5, k(inf) = 1/3.
double second_moment(double n) {
  return math::tgamma(3 / n) * math::tgamma(1 + 3 / n) / (math::tgamma(1 / n) * math::tgamma(1 + 5 / n));
}

}  // namespace

double volume(const HyperEllipsoid& shape) {
  const double n = shape.exponent;
  return 8 * shape.semi_axes.prod() * cube(math::tgamma(1 + 1 / n)) / math::tgamma(1 + 3 / n);
}

Vec3 principal_inertia(const HyperEllipsoid& shape, double mass) {
  const Vec3 squares = shape.semi_axes.cwiseAbs2();
  return mass * second_moment(shape.exponent) * (Vec3::Constant(squares.sum()) - squares);
}

Support support(const HyperEllipsoid& shape, const Vec3& direction) {
  assert(direction.squaredNorm() > 0 && "a support point needs a direction");
  if (shape.exponent == 2) {
    const Vec3 w = shape.semi_axes.cwiseProduct(direction);
    const double h = w.norm();
    return {h, shape.semi_axes.cwiseProduct(w / h)};
  }
  // s_i = a_i (w_i/h)^(1/(n-1)) with h^q = sum w_i^q, q = n/(n-1)
  const Vec3 w = shape.semi_axes.cwiseProduct(direction.cwiseAbs());
  const double largest = w.maxCoeff();
  const Vec3 u = w / largest, u_q1 = powers(u, 1 / (shape.exponent - 1));
  const double sum = u.dot(u_q1);
  const double scale = math::two_powers(sum, 1, -1 / shape.exponent)[0];
  Support out;
  out.value = largest * sum * scale;
  for (int i = 0; i < 3; ++i) out.point[i] = std::copysign(shape.semi_axes[i] * scale * u_q1[i], direction[i]);
  return out;
}

double support_value(const HyperEllipsoid& shape, const Vec3& direction) {
  return direction.squaredNorm() > 0 ? support(shape, direction).value : 0;
}

/// The dual norm lies between those of exponent 1 and 2. Its logarithm is convex in 1/q (Lyapunov), and a weighted geometric mean
/// is no more than the arithmetic one.
double support_bound(const HyperEllipsoid& shape, const Vec3& direction) {
  constexpr double kRounding = 1e-14;  // [-]
  const Vec3 w = shape.semi_axes.cwiseProduct(direction).cwiseAbs();
  const double of_box = 1 - 2 / shape.exponent;
  return (1 + kRounding) * (of_box * w.sum() + (1 - of_box) * w.norm());
}

Vec3 support_point(const HyperEllipsoid& shape, const Vec3& direction) {
  return support(shape, direction).point;
}

Mat3 support_hessian(const HyperEllipsoid& shape, const Vec3& direction, const Support& at) {
  const double n = shape.exponent, h = at.value;
  const double cap = kLargestRadius * shape.semi_axes.maxCoeff() * (n - 1) * h;
  Mat3 H = -at.point * at.point.transpose();
  for (int i = 0; i < 3; ++i) {
    // a^2 u^(q - 2) with u = a |d|/h, and u^(q - 1) = |s|/a
    const double a = shape.semi_axes[i], d = std::abs(direction[i]);
    H(i, i) += n == 2 ? a * a : (d > 0 ? std::min(cap, std::abs(at.point[i]) * h / d) : cap);
  }
  return H / ((n - 1) * h);
}

double gauge(const HyperEllipsoid& shape, const Vec3& x) {
  return norm_p(x.cwiseAbs().cwiseQuotient(shape.semi_axes), shape.exponent);
}

Vec3 gauge_gradient(const HyperEllipsoid& shape, const Vec3& x) {
  const double N = gauge(shape, x);
  if (N == 0) return Vec3::Zero();
  const Vec3 w = x.cwiseAbs().cwiseQuotient(shape.semi_axes) / N;
  const Vec3 steepness = powers(w, shape.exponent - 1).cwiseQuotient(shape.semi_axes);
  Vec3 g;
  for (int i = 0; i < 3; ++i) g[i] = std::copysign(steepness[i], x[i]);
  return g;
}

Mat3 gauge_hessian(const HyperEllipsoid& shape, const Vec3& x) {
  const double N = gauge(shape, x), n = shape.exponent;
  if (N == 0) return Mat3::Zero();
  const Vec3 g = gauge_gradient(shape, x);
  Mat3 H = -g * g.transpose();
  const Vec3 w = x.cwiseAbs().cwiseQuotient(shape.semi_axes) / N;
  H.diagonal() += (n == 2 ? Vec3(Vec3::Ones()) : powers(w, n - 2)).cwiseQuotient(shape.semi_axes.cwiseAbs2());
  return H * ((n - 1) / N);
}

Vec3 outward_normal(const HyperEllipsoid& shape, const Vec3& x) {
  return gauge_gradient(shape, x).normalized();
}

Vec3 radial_point(const HyperEllipsoid& shape, const Vec3& direction) {
  const double N = gauge(shape, direction);
  assert(N > 0 && "a radial point needs a direction");
  return direction / N;
}

Vec3 aabb_half_widths(const HyperEllipsoid& shape, const Quat& q_WB) {
  const Mat3 R = q_WB.toRotationMatrix();
  return {support_value(shape, R.row(0).transpose()), support_value(shape, R.row(1).transpose()),
          support_value(shape, R.row(2).transpose())};
}

}  // namespace engine
