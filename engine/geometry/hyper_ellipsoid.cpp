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

/// base^exponent of three bases >= 0. One of them is mostly 1, where all are shares of the largest. Inline, as `unscaled`: called,
/// they pass vectors through memory, which takes as long as a logarithm that is spared.
[[gnu::always_inline]] inline Vec3 powers(const Vec3& bases, double exponent) {
  const int alone = bases[0] == 1 ? 0 : bases[1] == 1 ? 1 : 2;
  const int i = (alone + 1) % 3, j = (alone + 2) % 3;
  const Eigen::Vector2d two = math::two_powers(bases[i], bases[j], exponent);
  Vec3 out;
  out[i] = two[0];
  out[j] = two[1];
  out[alone] = bases[alone] == 1 ? 1 : math::two_powers(bases[alone], 1, exponent)[0];
  return out;
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

namespace {

[[gnu::always_inline]] inline UnscaledSupport unscaled(const HyperEllipsoid& shape, const Vec3& direction) {
  assert(direction.squaredNorm() > 0 && "a support point needs a direction");
  if (shape.exponent == 2) {
    const Vec3 w = shape.semi_axes.cwiseProduct(direction);
    const double h = w.norm();
    return {{h, shape.semi_axes.cwiseProduct(w / h)}, 1, 2};
  }
  // s_i = a_i (w_i/h)^(1/(n-1)) with h^q = sum w_i^q, q = n/(n-1)
  const Vec3 w = shape.semi_axes.cwiseProduct(direction.cwiseAbs());
  const double largest = w.maxCoeff();
  const Vec3 u = w / largest, u_q1 = powers(u, 1 / (shape.exponent - 1));
  UnscaledSupport out;
  out.sum = u.dot(u_q1);
  out.n = shape.exponent;
  out.of.value = largest * out.sum;
  for (int i = 0; i < 3; ++i) out.of.point[i] = std::copysign(shape.semi_axes[i] * u_q1[i], direction[i]);
  return out;
}

}  // namespace

UnscaledSupport unscaled_support(const HyperEllipsoid& shape, const Vec3& direction) {
  return unscaled(shape, direction);
}

std::array<Support, 2> scaled(const UnscaledSupport& a, const UnscaledSupport& b) {
  const Eigen::Vector2d scale = math::two_powers({a.sum, b.sum}, {-1 / a.n, -1 / b.n});
  return {Support{scale[0] * a.of.value, scale[0] * a.of.point}, Support{scale[1] * b.of.value, scale[1] * b.of.point}};
}

Support support(const HyperEllipsoid& shape, const Vec3& direction) {
  const UnscaledSupport one = unscaled(shape, direction);
  if (one.sum == 1) return one.of;
  const double scale = math::two_powers(one.sum, 1, -1 / one.n)[0];
  return {scale * one.of.value, scale * one.of.point};
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

GaugeAt gauge_at(const HyperEllipsoid& shape, const Vec3& x) {
  const Vec3 w = x.cwiseAbs().cwiseQuotient(shape.semi_axes);
  int top = 0;
  const double largest = w.maxCoeff(&top);
  if (largest == 0) return {0, Vec3::Zero()};
  const int i = (top + 1) % 3, k = (top + 2) % 3;
  const double n = shape.exponent, u_i = w[i] / largest, u_k = w[k] / largest;
  const Eigen::Vector2d steep = math::two_powers(u_i, u_k, n - 1);
  const double sum = 1 + u_i * steep[0] + u_k * steep[1], root = math::two_powers(sum, 1, 1 / n)[0];
  Vec3 gradient;
  gradient[top] = 1;
  gradient[i] = steep[0];
  gradient[k] = steep[1];
  gradient = (root / sum * gradient).cwiseQuotient(shape.semi_axes);
  for (int j = 0; j < 3; ++j) gradient[j] = std::copysign(gradient[j], x[j]);
  return {largest * root, gradient};
}

double gauge(const HyperEllipsoid& shape, const Vec3& x) {
  return gauge_at(shape, x).value;
}

Vec3 gauge_gradient(const HyperEllipsoid& shape, const Vec3& x) {
  return gauge_at(shape, x).gradient;
}

Mat3 gauge_hessian(const HyperEllipsoid& shape, const Vec3& x) {
  const auto [N, g] = gauge_at(shape, x);
  const double n = shape.exponent;
  if (N == 0) return Mat3::Zero();
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
