// Everything is scaled by its largest term before a power is taken, so that n = 30 neither over- nor underflows.
#include "engine/geometry/hyper_ellipsoid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace engine {
namespace {

/// Curvature radii are infinite on the flat faces of n > 2; capped at this many times the size they do no harm to Newton's method.
constexpr double kLargestRadius = 1e3;

double power(double base, double exponent) {
  if (exponent == 1 || base == 1) return base;
  if (exponent == 2) return base * base;
  if (exponent == 0.5) return std::sqrt(base);
  if (exponent == 1.5) return base * std::sqrt(base);
  return std::pow(base, exponent);
}

/// (sum (w_i)^p)^(1/p) for w >= 0.
double norm_p(const Vec3& w, double p) {
  if (p == 2) return w.norm();
  const double largest = w.maxCoeff();
  if (largest == 0) return 0;
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += power(w[i] / largest, p);
  return largest * power(sum, 1 / p);
}

/// Integral of x^2 over the body per a^2 and volume: k(2) = 1/5, k(inf) = 1/3.
double second_moment(double n) {
  return std::tgamma(3 / n) * std::tgamma(1 + 3 / n) / (std::tgamma(1 / n) * std::tgamma(1 + 5 / n));
}

}  // namespace

double volume(const HyperEllipsoid& shape) {
  const double n = shape.exponent;
  return 8 * shape.semi_axes.prod() * std::pow(std::tgamma(1 + 1 / n), 3) / std::tgamma(1 + 3 / n);
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
  Vec3 powers;
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double u = w[i] / largest;
    powers[i] = u == 0 ? 0 : power(u, 1 / (shape.exponent - 1));
    sum += u * powers[i];
  }
  const double scale = 1 / power(sum, 1 / shape.exponent);
  Support out;
  out.value = largest * sum * scale;
  for (int i = 0; i < 3; ++i) out.point[i] = std::copysign(shape.semi_axes[i] * scale * powers[i], direction[i]);
  return out;
}

double support_value(const HyperEllipsoid& shape, const Vec3& direction) {
  return direction.squaredNorm() > 0 ? support(shape, direction).value : 0;
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
  Vec3 g;
  for (int i = 0; i < 3; ++i) {
    const double w = std::abs(x[i]) / (shape.semi_axes[i] * N);
    g[i] = std::copysign(power(w, shape.exponent - 1) / shape.semi_axes[i], x[i]);
  }
  return g;
}

Mat3 gauge_hessian(const HyperEllipsoid& shape, const Vec3& x) {
  const double N = gauge(shape, x), n = shape.exponent;
  if (N == 0) return Mat3::Zero();
  const Vec3 g = gauge_gradient(shape, x);
  Mat3 H = -g * g.transpose();
  for (int i = 0; i < 3; ++i) {
    const double w = std::abs(x[i]) / (shape.semi_axes[i] * N);
    H(i, i) += (n == 2 ? 1 : power(w, n - 2)) / (shape.semi_axes[i] * shape.semi_axes[i]);
  }
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
