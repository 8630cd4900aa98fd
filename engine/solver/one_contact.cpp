#include "engine/solver/one_contact.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/math/roots.h"

namespace engine {
namespace {

/// Tangential impulse of a contact that slips: (S + y) t = -q with y > 0 such that |t| = most(t), S positive definite. At y = 0
/// (stick) the left side is larger, for large y the right, so a root lies between; 1/|t| - 1/most is nearly straight in y: Newton,
/// kept inside the bracket. `most` returns the bound and its rate for a change of t. Across itself a tyre yields by `soft` already
/// where it grips, and by its slide where that is more: so a wheel goes from the one to the other without a jump.
template <class Bound>
Eigen::Vector2d slip_impulse(const Eigen::Matrix2d& S, const Eigen::Vector2d& q, double y, double soft, const Bound& most) {
  constexpr double kTight = 1e-12, kNewtonSquares = 1e-6;  // [-] Newton squares what is missing: from there its step is the last
  math::Bracket bracket{0, std::numeric_limits<double>::infinity()};
  const double &low = bracket.low, &high = bracket.high;
  Eigen::Vector2d t = Eigen::Vector2d::Zero();
  for (int k = 0; k < 60; ++k) {
    const double s11 = S(0, 0) + y, s22 = S(1, 1) + std::max(y, soft), det = s11 * s22 - S(0, 1) * S(0, 1);
    t = {-(s22 * q[0] - S(0, 1) * q[1]) / det, -(s11 * q[1] - S(0, 1) * q[0]) / det};
    const double across = y >= soft ? t[1] : 0.0;
    const Eigen::Vector2d slope(-(s22 * t[0] - S(0, 1) * across) / det, -(s11 * across - S(0, 1) * t[0]) / det);
    const auto [bound, bound_rate] = most(t, slope);
    const double length = t.norm();
    if (std::abs(length - bound) <= kTight * length) break;
    (length > bound ? bracket.low : bracket.high) = y;
    double next = -1;
    if (bound > 0 && length > 0) {
      const double value = 1 / length - 1 / bound;
      const double rate = -t.dot(slope) / (length * length * length) + bound_rate / (bound * bound);
      if (rate > 0) next = y - value / rate;
      const bool smooth = (y < soft) == (next < soft);
      if (std::abs(length - bound) <= kNewtonSquares * length && bracket.contains(next) && smooth) return t + (next - y) * slope;
    }
    if (!bracket.contains(next))
      next = std::isfinite(high) ? std::sqrt(std::max(low, 1e-9 * high) * high) : 4 * std::max(y, S.trace());
    next = bracket.inside(next);
    if (std::isfinite(high) && high - low <= 1e-14 * high) break;
    y = next;
  }
  return t;
}

/// Tangential impulse no larger than `bound` that stops the slip, or opposes what is left of it; `u` is the slip with `old`.
Eigen::Vector2d bounded_tangents(const Eigen::Matrix2d& S, const Eigen::Vector2d& u, const Eigen::Vector2d& old, double soft,
                                 double bound) {
  const Eigen::Vector2d q = u - S * old;
  Eigen::Matrix2d gripping = S;
  gripping(1, 1) += soft;
  const Eigen::Vector2d stop = -gripping.inverse() * q;
  if (stop.norm() <= bound) return stop;
  if (!(bound > 0)) return Eigen::Vector2d::Zero();
  const double last = old.norm();
  return slip_impulse(S, q, last > 0 ? u.norm() / last : S.trace(), soft,
                      [&](const auto&, const auto&) { return std::pair(bound, 0.0); });
}

}  // namespace

Vec3 solve_wheel(const Mat3& A, const Vec3& u, const Vec3& old, const Constraint& c) {
  // normal first, then the ground plane: rolling direction bounded by brake and engine, both by the friction circle
  const double normal = std::max(0.0, old[0] + (c.target - u[0] - c.softness * old[0]) / (A(0, 0) + c.softness));
  const Vec3 u1 = u + A.col(0) * (normal - old[0]);
  const double most = c.surface.friction * normal;
  const double soft = c.wheel.grip_softness;
  // the tyre grips: the impulse that stops its contact, but for the slip angle
  const double a22 = A(2, 2) + soft, v = u1[2] + soft * old[2];
  const double det = A(1, 1) * a22 - A(1, 2) * A(2, 1);
  Eigen::Vector2d held(old[1] - (a22 * u1[1] - A(1, 2) * v) / det, old[2] - (A(1, 1) * v - A(2, 1) * u1[1]) / det);
  // locked it slides like a block, against its slip; it has no slip angle. Locked it is as long as the brake bears what of that
  // lies along the wheel: a car that slides sideways with its brakes on is slowed sideways
  if (held.norm() > most) held = bounded_tangents(A.bottomRightCorner<2, 2>(), u1.tail<2>(), old.tail<2>(), soft, most);
  if (std::abs(held[0] - c.wheel.driving) <= c.wheel.braking) return {normal, held[0], held[1]};
  // it turns: brake and engine have their share first, what grip is left holds sideways
  const double x = std::clamp(c.wheel.driving + std::copysign(c.wheel.braking, held[0] - c.wheel.driving), -most, most);
  const double y = old[2] - (u1[2] + soft * old[2] + A(2, 1) * (x - old[1])) / (A(2, 2) + soft);
  if (length_of(x, y) <= most) return {normal, x, y};
  return {normal, x, std::copysign(std::sqrt(std::max(0.0, most * most - x * x)), y)};
}

double natural_residual(const Constraint& c, const Vec3& u, const Mat3& A) {
  const double a = A(0, 0) + c.softness;
  const double miss = u[0] + c.softness * c.impulse[0] - c.target;
  switch (c.kind) {
    case ConstraintKind::bilateral:
      return std::abs(miss);
    case ConstraintKind::limit:
      return (c.slides ? 1.0 : kLimitArm) * std::abs(c.impulse[0] - std::max(0.0, c.impulse[0] - miss / a)) * a;
    case ConstraintKind::wheel: {
      // the soft normal answers to the suspension, the road plane to the tyre: each by its own response
      const Vec3 change = solve_wheel(A, u, c.impulse, c) - c.impulse;
      return std::max(std::abs(change[0]) * a, length_of(change[1] * A(1, 1), change[2] * (A(2, 2) + c.wheel.grip_softness)));
    }
    case ConstraintKind::contact:
      break;
  }
  const double rho = 1 / A.diagonal().maxCoeff();
  const double slip = length_of(u[1], u[2]);
  const Vec3 moved = c.impulse - rho * Vec3(miss + c.surface.friction * slip, u[1], u[2]);
  return (c.impulse - project_to_cone(moved, c.surface.friction)).norm() / rho;
}

Vec3 project_to_cone(const Vec3& impulse, double mu) {
  const double tangential = length_of(impulse[1], impulse[2]);
  if (mu * tangential <= -impulse[0]) return Vec3::Zero();  // first: without friction what pulls would pass for inside
  if (tangential <= mu * impulse[0]) return impulse;
  const double normal = (impulse[0] + mu * tangential) / (1 + mu * mu);
  const double scale = tangential > 0 ? mu * normal / tangential : 0;
  return {normal, scale * impulse[1], scale * impulse[2]};
}

Vec3 solve_one_contact(const Mat3& A, const Vec3& b, double target, double mu, const Vec3& guess) {
  if (b[0] >= target) return Vec3::Zero();
  const Vec3 stick = A.inverse() * Vec3(target - b[0], -b[1], -b[2]);
  if (stick[0] >= 0 && length_of(stick[1], stick[2]) <= mu * stick[0]) return stick;
  const double c = (target - b[0]) / A(0, 0);
  if (mu <= 0) return {c, 0, 0};

  // slip: u_t = -y L_t. The normal equation L_n = c - d.L_t put into the tangential ones leaves the two of slip_impulse
  const Eigen::Vector2d A_nt(A(0, 1), A(0, 2));
  const Eigen::Vector2d d = A_nt / A(0, 0);
  const Eigen::Matrix2d S = A.bottomRightCorner<2, 2>() - d * A_nt.transpose();
  const double last = guess.tail<2>().norm();
  const double y = last > 0 ? (b + A * guess).tail<2>().norm() / last : S.trace();
  const Eigen::Vector2d t = slip_impulse(S, b.tail<2>() + A_nt * c, y, 0.0, [&](const auto& L_t, const auto& slope) {
    return std::pair(mu * (c - d.dot(L_t)), -mu * d.dot(slope));
  });
  return project_to_cone({c - d.dot(t), t[0], t[1]}, mu);
}

}  // namespace engine
