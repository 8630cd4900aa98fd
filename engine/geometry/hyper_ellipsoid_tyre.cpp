#include "engine/geometry/hyper_ellipsoid_tyre.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/math/functions.h"

namespace engine {
namespace {

constexpr double kFlat = 8;            // [-] least exponent of a shape with flat sides
constexpr double kLeastAcross = 1e-9;  // [-] of a direction along the axle, where the rim's side is flat

/// Support function of the tyre about its centre, its point and its second derivative.
struct TyreSupport {
  double value = 0;
  Vec3 point = Vec3::Zero();
  Mat3 second = Mat3::Zero();
};
TyreSupport support_of(const Tyre& tyre, const Vec3& m) {
  const double length = m.norm(), ring = tyre.radius - tyre.crown;
  const Vec3 across = m - m.dot(tyre.axle) * tyre.axle;
  const double rho = std::max(across.norm(), kLeastAcross * length);
  TyreSupport out;
  out.value = ring * across.norm() + tyre.crown * length;
  out.point = ring / rho * across + tyre.crown / length * m;
  const Mat3 square = Mat3::Identity() - tyre.axle * tyre.axle.transpose();
  out.second = ring / rho * (square - across * across.transpose() / (rho * rho)) +
               tyre.crown / length * (Mat3::Identity() - m * m.transpose() / (length * length));
  return out;
}

/// The way as a function of the slope s of a normal m = along + E s, with its derivatives.
struct Way {
  const Tyre& tyre;
  const HyperEllipsoid& shape;
  Mat3 R_WA;
  Vec3 apart;  // c_T - c_A
  Vec3 along;
  Eigen::Matrix<double, 3, 2> E;

  Vec3 normal(const Eigen::Vector2d& s) const { return along + E * s; }
  double value(const Vec3& m) const {
    return support_of(tyre, m).value + support_value(shape, R_WA.transpose() * m) - m.dot(apart);
  }
  void derivatives(const Vec3& m, Eigen::Vector2d& slope, Eigen::Matrix2d& second) const {
    const TyreSupport of_tyre = support_of(tyre, m);
    const Vec3 unit_A = (R_WA.transpose() * m).normalized();
    const Support of_shape = support(shape, unit_A);
    const Mat3 H = of_tyre.second + R_WA * support_hessian(shape, unit_A, of_shape) * R_WA.transpose() / m.norm();
    slope = E.transpose() * (of_tyre.point + R_WA * of_shape.point - apart);
    second = E.transpose() * H * E;
  }
};

/// The best normal so far, and its way.
struct Lowest {
  Eigen::Vector2d s;
  double way;
};

/// Where looking on changes nothing: the way is convex, and what is steeper gets no better. It may fall for ever towards there.
struct Bounds {
  double least, steepest;
  bool passed_by(const Lowest& at) const { return at.way < least || at.s.norm() > steepest; }
};

/// Newton's method, damped. True when it is done: at the minimum, or past the bounds.
bool descend(const Way& way, Lowest& at, const Bounds& bounds) {
  constexpr int kIterations = 60;
  constexpr double kStationary = 1e-10;  // [m] of the slope; the way errs by its square over the radius
  double damping = 1e-6 * way.tyre.radius;
  for (int k = 0; k < kIterations; ++k) {
    Eigen::Vector2d slope;
    Eigen::Matrix2d second;
    way.derivatives(way.normal(at.s), slope, second);
    if (slope.norm() < kStationary) return true;
    bool better = false;
    for (int trial = 0; trial < 16 && !better; ++trial) {
      Eigen::Vector2d step = -(second + damping * Eigen::Matrix2d::Identity()).inverse() * slope;
      if (const double far = step.norm() / (1 + at.s.norm()); far > 1) step /= far;
      const double next = way.value(way.normal(at.s + step));
      better = next < at.way;
      damping *= better ? 0.1 : 10;
      if (better) at = {at.s + step, next};
    }
    if (bounds.passed_by(at)) return true;
    if (!better) return false;
  }
  return false;
}

/// On a part with flat sides Newton stalls at its edges: there the way all but has kinks, where the normal is across a body axis.
/// Steps along and across those, ever shorter; down a long slope as far again as it has come (Hooke and Jeeves 1961).
void creep_down(const Way& way, Lowest& at, const Bounds& bounds) {
  constexpr double kFirst = 0.3, kLast = 1e-8;  // [-] of the slope s
  constexpr int kMostSteps = 1000;              // of one reach; some ten are usual
  constexpr int kLong = 20;                     // of them make a long slope
  for (double reach = kFirst; reach > kLast; reach *= 0.5) {
    bool better = true;
    Eigen::Vector2d before = at.s;
    for (int k = 0; better && k < kMostSteps; ++k) {
      better = false;
      for (double share = 1; k > 0 && k % kLong == 0; share *= 2) {
        const Eigen::Vector2d s = at.s + share * (at.s - before);
        const double next = way.value(way.normal(s));
        before = at.s;
        if (!(next < at.way)) break;
        at = {s, next};
        if (bounds.passed_by(at)) return;
      }
      for (int i = 0; i < 12; ++i) {
        const Eigen::Vector2d across = way.E.transpose() * way.R_WA.col(i % 3);
        if (!(across.norm() > 1e-6)) continue;
        const Eigen::Vector2d kink = across.normalized(), to = i % 2 ? kink : kink.unitOrthogonal();
        const Eigen::Vector2d s = at.s + (i < 6 ? reach : -reach) * to;
        if (const double next = way.value(way.normal(s)); next < at.way) at = {s, next}, better = true;
        if (bounds.passed_by(at)) return;
      }
    }
  }
}

/// On a flat side, well within its rim, the normal is the body's axis: there Newton's method has nothing to go by.
std::optional<Lowest> on_flat_side(const Way& way) {
  constexpr double kBent = 1e-7;  // [m] by which the side has fallen away there from its middle
  const HyperEllipsoid& shape = way.shape;
  if (shape.exponent < kFlat) return std::nullopt;
  for (int i = 0; i < 3; ++i) {
    const double facing = way.R_WA.col(i).dot(way.along);
    if (std::abs(facing) < 0.5) continue;
    const Vec3 m = way.R_WA.col(i) / facing;
    const Vec3 on = way.R_WA.transpose() * (way.apart - support_of(way.tyre, m).point);
    double share = 0;
    for (int k = 0; k < 3; ++k)
      if (k != i) share += math::pow(std::min(1.0, std::abs(on[k]) / shape.semi_axes[k]), shape.exponent);
    if (shape.semi_axes[i] * share < kBent * shape.exponent) return Lowest{way.E.transpose() * m, way.value(m)};
  }
  return std::nullopt;
}

}  // namespace

std::optional<TyreTouch> move_clear(const Tyre& tyre, const HyperEllipsoid& shape, const Pose& X_WA, const Vec3& along,
                                    double facing, double least) {
  Way way{tyre, shape, X_WA.q.toRotationMatrix(), tyre.centre - X_WA.p, along, {}};
  way.E.col(0) = along.unitOrthogonal();
  way.E.col(1) = along.cross(way.E.col(0));
  const double steepest = std::sqrt(1 / (facing * facing) - 1);
  Lowest at{Eigen::Vector2d::Zero(), way.value(along)};
  const Bounds bounds{least, 2 * steepest};
  if (const auto flat = on_flat_side(way))
    at = *flat;
  else if (!descend(way, at, bounds))
    creep_down(way, at, bounds);
  if (at.s.norm() > steepest || at.way < least) return std::nullopt;
  const Vec3 m = way.normal(at.s);
  TyreTouch touch;
  touch.way = at.way;
  touch.normal = m.normalized();
  touch.point = tyre.centre + at.way * along - support_of(tyre, m).point;  // of a flat side any point would be the shape's
  return touch;
}

std::optional<SurfaceContact> contact_with_tyre(const HyperEllipsoid& shape, const Pose& X_WA, const Tyre& tyre, double margin) {
  constexpr int kTurns = 3;  // towards the normal at which it touches: exact for two that touch, as near as that where they do not
  constexpr double kAny = 0.05;
  Vec3 along = tyre.centre - X_WA.p;
  if (!(along.norm() > 0)) return std::nullopt;
  if (shape.exponent < kFlat) {
    along.normalize();
  } else {
    // from the side before which the tyre stands
    const Vec3 from = X_WA.q.conjugate() * along;
    int side = 0;
    from.cwiseAbs().cwiseQuotient(shape.semi_axes).maxCoeff(&side);
    along = X_WA.q * (std::copysign(1.0, from[side]) * Vec3::Unit(side));
  }
  std::optional<TyreTouch> touch;
  for (int k = 0; k < kTurns; ++k) {
    const auto next = move_clear(tyre, shape, X_WA, along, kAny, -2 * (margin + tyre.radius) / kAny);
    if (!next) return std::nullopt;
    touch = next;
    if (-touch->way * touch->normal.dot(along) > 2 * margin + 0.1) return std::nullopt;
    along = touch->normal;
  }
  SurfaceContact c;
  c.normal = -touch->normal;
  c.p_a = X_WA.p + X_WA.q * support_point(shape, X_WA.q.conjugate() * touch->normal);
  c.p_b = tyre.centre - support_of(tyre, touch->normal).point;
  c.gap = c.normal.dot(c.p_a - c.p_b);
  if (c.gap >= margin) return std::nullopt;
  return c;
}

}  // namespace engine
