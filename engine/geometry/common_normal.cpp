// Two ways to the maximum of the gap. Far from it, Newton on the sphere: (E^T (H_A + H_B) E + g 1 + mu 1) s = E^T (d - s(n)), mu as
// in Levenberg-Marquardt. Near it, Newton on the tangential miss E^T (d - s(n)) itself, in coordinates in which it is smooth.
//
// Near the flats of n > 2 the support function has all but kinks where the direction lies across a body axis: the farthest point
// goes as |u|^(1/(n - 1)), u = a d. In t = |u|^(1/(n - 1)) it is linear, and t is all but the place on the flat side. So each step
// is taken in t of the shape that is flatter there.
#include "engine/geometry/common_normal.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/math/functions.h"
#include "engine/math/roots.h"

namespace engine {

double RoundPair::gap(const Vec3& n) const {
  return at(n).gap;
}

RoundPair::At RoundPair::at(const Vec3& n) const {
  return at(n, 0, unscaled_support(*shape[0], R_WS[0].transpose() * n));
}

RoundPair::At RoundPair::at(const Vec3& n, std::size_t known, const UnscaledSupport& its) const {
  At out;
  out.n = n;
  for (std::size_t s = 0; s < 2; ++s) out.n_S[s] = R_WS[s].transpose() * n;
  const UnscaledSupport other = unscaled_support(*shape[1 - known], out.n_S[1 - known]);
  out.reach = known == 0 ? scaled(its, other) : scaled(other, its);
  out.gap = n.dot(d) - out.reach[0].value - out.reach[1].value;
  out.sum = R_WS[0] * out.reach[0].point + R_WS[1] * out.reach[1].point;
  return out;
}

Mat3 RoundPair::hessian(const At& p, std::size_t s) const {
  return R_WS[s] * support_hessian(*shape[s], p.n_S[s], p.reach[s]) * R_WS[s].transpose();
}

namespace {

using At = RoundPair::At;
using Tangents = Eigen::Matrix<double, 3, 2>;

Tangents tangents(const Vec3& n) {
  const Vec3 t = n.unitOrthogonal();
  Tangents E;
  E << t, n.cross(t);
  return E;
}

Eigen::Vector2d tangential_miss(const RoundPair& pair, const At& at) {
  return tangents(at.n).transpose() * (pair.d - at.sum);
}

bool positive(const Eigen::Matrix2d& M) {
  return M.determinant() > 0 && M.trace() > 0;
}

/// Coordinates of directions near `at` by the place on one shape's surface that is farthest along them: t, all but one free.
class SurfaceChart {
 public:
  SurfaceChart(const RoundPair& pair, std::size_t shape, const At& at)
      : pair_(pair), which_(shape), shape_(*pair.shape[shape]), t_(at.reach[shape].point.cwiseQuotient(shape_.semi_axes)) {
    scale_ = t_.cwiseAbs().maxCoeff(&fixed_);
    t_ /= scale_;
    const Vec3 u = shape_.semi_axes.cwiseProduct(at.n_S[shape]);
    u_ = u / std::abs(u[fixed_]);
  }

  /// Newton's step on the tangential miss, in the two free coordinates; not finite where there is none.
  Eigen::Vector2d step(const At& at, const Eigen::Vector2d& miss) const {
    const Tangents E = tangents(at.n);
    const Mat3 other = pair_.hessian(at, 1 - which_) + at.gap * Mat3::Identity();
    const double sum = u_.dot(t_);
    const double length = u_.cwiseQuotient(shape_.semi_axes).norm();
    Eigen::Matrix2d M;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Index i = free(k);
      const double steepness = shape_.exponent == 2 ? 1 : t_[i] == 0 ? 0 : u_[i] / t_[i];  // |t|^(n - 2)
      Vec3 point = -u_[i] / sum * shape_.semi_axes.cwiseProduct(t_);
      point[i] += shape_.semi_axes[i];
      const Vec3 turn = pair_.R_WS[which_].col(i) * ((shape_.exponent - 1) * steepness / (shape_.semi_axes[i] * length));
      M.col(k) = E.transpose() * (pair_.R_WS[which_] * (scale_ * point) + other * (turn - turn.dot(at.n) * at.n));
    }
    return M.inverse() * miss;
  }

  /// Where the coordinates moved by `step` lead.
  At moved(const Eigen::Vector2d& step) const {
    Vec3 t = t_;
    for (int k = 0; k < 2; ++k) t[free(k)] += step[k];
    const double n = shape_.exponent;
    const Eigen::Vector2d powers = math::two_powers(std::abs(t[free(0)]), std::abs(t[free(1)]), n - 1);
    Vec3 u = t;
    for (int k = 0; k < 2; ++k) u[free(k)] = std::copysign(powers[k], t[free(k)]);
    const Vec3 direction = u.cwiseQuotient(shape_.semi_axes);
    const double sum = u.dot(t), length = direction.norm();
    return pair_.at(pair_.R_WS[which_] * (direction / length), which_, {{sum / length, shape_.semi_axes.cwiseProduct(t)}, sum, n});
  }

 private:
  Eigen::Index free(int k) const { return (fixed_ + 1 + k) % 3; }

  const RoundPair& pair_;
  std::size_t which_;
  const HyperEllipsoid& shape_;
  Vec3 t_, u_;
  Eigen::Index fixed_ = 0;
  double scale_ = 1;
};

std::size_t flatter(const RoundPair& pair, const At& at) {
  auto radii = [&](std::size_t s) {
    const Vec3& n = at.n_S[s];
    const Mat3 H = support_hessian(*pair.shape[s], n, at.reach[s]);
    return H.trace() - n.dot(H * n);
  };
  return radii(1) > radii(0) ? 1 : 0;
}

/// Turns n about the unit axis w by the angle at which the gap stops growing: bisection on its slope (w x n).(d - s(n)), which
/// knows the angle to rounding where the gap itself knows it to the root of rounding only. Returns the angle.
double climb_about(const RoundPair& pair, const Vec3& w, double tolerance, Vec3& n) {
  constexpr double kFirst = 1e-7, kGrowth = 6, kFarthest = 0.5;  // [rad]
  const Vec3 across = w.cross(n), along = w.dot(n) * w;
  auto turned = [&](double angle) -> Vec3 { return math::cos(angle) * (n - along) + math::sin(angle) * across + along; };
  auto slope = [&](double angle) {
    const Vec3 m = turned(angle);
    return w.cross(m).dot(pair.d - pair.at(m).sum);
  };
  const double start = slope(0);
  if (std::abs(start) < 1e-15) return 0;
  const double sense = start > 0 ? 1 : -1;
  double low = 0, high = std::max(kFirst, tolerance);
  while (sense * slope(sense * high) > 0) {
    low = high;
    if (high > kFarthest) break;
    high *= kGrowth;
  }
  low = math::bisect({low, high}, math::kToTheWidth, tolerance, [&](double angle) { return sense * slope(sense * angle) > 0; }).low;
  n = turned(sense * low).normalized();
  return low;
}

/// Climbs along and across the circles of kinks nearby by turns, each to where the gap stops growing.
CommonNormal along_kinks(const RoundPair& pair, const CommonNormal& from, double tolerance) {
  constexpr double kNearby = 0.3;  // [-] sine of the angle to a kink
  constexpr int kRounds = 200, kAround = 16;
  At at = from.at;
  for (int round = 0; round < kRounds; ++round) {
    Vec3 n = at.n;
    double moved = 0;
    auto turn_about = [&](const Vec3& axis) { moved = std::max(moved, climb_about(pair, axis, tolerance, n)); };
    bool kinks = false;
    for (const Mat3& R : pair.R_WS)
      for (int i = 0; i < 3; ++i) {
        const Vec3 axis = R.col(i);
        if (std::abs(n.dot(axis)) > kNearby) continue;
        kinks = true;
        turn_about(n.cross(axis).normalized());
        turn_about(axis);
      }
    const Vec3 t = n.unitOrthogonal();
    if (!kinks) {
      turn_about(t);
      turn_about(n.cross(t).normalized());
    }
    // two ridges that cross at a slant leave a narrow way up between the directions of both
    for (int k = 0; k < kAround && moved <= 2 * tolerance; ++k) {
      const Vec3 across = n.unitOrthogonal();
      const double turn = std::numbers::pi * k / kAround;
      turn_about(math::cos(turn) * across + math::sin(turn) * n.cross(across));
    }
    at = pair.at(n);
    if (moved <= 2 * tolerance) break;
    if (close_in(pair, at)) return {at, true};
  }
  return at.gap >= from.at.gap - 1e-15 ? CommonNormal{at, false} : from;
}

}  // namespace

CommonNormal climb(const RoundPair& pair, const Vec3& n, int steps) {
  constexpr double kStationary = 1e-9;  // [m] of the tangential miss; the gap errs by its square over the radius
  At at = pair.at(n);
  double damping = 1e-3 * pair.d.norm() + 1e-6;
  for (int k = 0; k < steps; ++k) {
    const Tangents E = tangents(at.n);
    const Eigen::Vector2d slope = E.transpose() * (pair.d - at.sum);
    if (slope.norm() < kStationary) return {at, true};
    const Mat3 H_W = pair.hessian(at, 0) + pair.hessian(at, 1);
    const Eigen::Matrix2d H = E.transpose() * H_W * E + at.gap * Eigen::Matrix2d::Identity();
    bool better = false;
    for (int trial = 0; trial < 12 && !better; ++trial) {
      const Eigen::Matrix2d M = H + damping * Eigen::Matrix2d::Identity();
      if (positive(M)) {
        Eigen::Vector2d s = M.inverse() * slope;
        if (s.norm() > 0.5) s *= 0.5 / s.norm();
        const At next = pair.at((at.n + E * s).normalized());
        better = next.gap > at.gap;
        if (better) at = next;
      }
      damping = better ? 0.1 * damping : 8 * damping;
    }
    if (!better) break;
  }
  return {at, false};
}

bool close_in(const RoundPair& pair, At& at) {
  constexpr double kSmall = 1e-12;  // [m] of the tangential miss; the gap errs by its square over the radius
  constexpr int kSteps = 30, kShortened = 5;
  if (at.closed) return true;
  At here = at;
  Eigen::Vector2d miss = tangential_miss(pair, here);
  bool by_itself = miss.norm() <= kSmall;
  for (int k = 0; k < kSteps && !by_itself; ++k) {
    const SurfaceChart chart(pair, flatter(pair, here), here);
    Eigen::Vector2d step = chart.step(here, miss);
    if (!(step.norm() < 1)) step *= 1 / step.norm();
    if (!step.allFinite()) return false;
    bool nearer = false;
    for (int trial = 0; trial < kShortened && !nearer; ++trial, step *= 0.4) {
      const At next = chart.moved(step);
      const Eigen::Vector2d left = tangential_miss(pair, next);
      nearer = left.norm() < 0.8 * miss.norm();
      if (!nearer) continue;
      here = next;
      miss = left;
    }
    by_itself = !nearer || miss.norm() <= kSmall;
  }
  if (miss.norm() > kSmall || here.gap < at.gap - 1e-15) return false;
  const Tangents E = tangents(here.n);
  const Mat3 H = pair.hessian(here, 0) + pair.hessian(here, 1) + here.gap * Mat3::Identity();
  if (!positive(E.transpose() * H * E)) return false;
  at = here;
  at.closed = by_itself;
  return true;
}

CommonNormal settle(const RoundPair& pair, const CommonNormal& from, double tolerance) {
  CommonNormal top = from;
  if (close_in(pair, top.at)) return {top.at, true};
  return along_kinks(pair, from, tolerance);
}

}  // namespace engine
