// The common normal maximises the signed gap   g(n) = n.(c_A - c_B) - h_A(n) - h_B(n)   over unit n (from B to A): where it is
// stationary the tangent planes are parallel and (c_A - c_B) - s(n) is along n, the source's (75), (76). Apart, g is concave and
// its maximum the distance; overlapping, the largest maximum is the least depth and there can be several, so the search starts from
// many directions. g at any n is a lower bound of the gap and second order in the error of n: gap and points always come from
// g at the final n. Newton on the sphere: (E^T (H_A + H_B) E + g 1 + mu 1) s = E^T ((c_A - c_B) - s(n)), mu as in
// Levenberg-Marquardt.
#include "engine/geometry/hyper_ellipsoid_pair.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/math/functions.h"
#include "engine/math/roots.h"

namespace engine {
namespace {

struct Pair {
  const HyperEllipsoid& A;
  const HyperEllipsoid& B;
  Mat3 R_WA, R_WB;
  Vec3 d;  // c_A - c_B

  double gap(const Vec3& n) const {
    return n.dot(d) - support_value(A, R_WA.transpose() * n) - support_value(B, R_WB.transpose() * n);
  }
  Vec3 support_sum(const Vec3& n) const {
    return R_WA * support_point(A, R_WA.transpose() * n) + R_WB * support_point(B, R_WB.transpose() * n);
  }

  /// All there is to know at n.
  struct At {
    Vec3 n, n_A, n_B;
    Support a, b;
    double gap;
    Vec3 sum;  // of the support points, world axes
  };
  At at(const Vec3& n) const {
    At out;
    out.n = n;
    out.n_A = R_WA.transpose() * n;
    out.n_B = R_WB.transpose() * n;
    out.a = support(A, out.n_A);
    out.b = support(B, out.n_B);
    out.gap = n.dot(d) - out.a.value - out.b.value;
    out.sum = R_WA * out.a.point + R_WB * out.b.point;
    return out;
  }
  Mat3 hessian_sum(const At& p) const {
    return R_WA * support_hessian(A, p.n_A, p.a) * R_WA.transpose() + R_WB * support_hessian(B, p.n_B, p.b) * R_WB.transpose();
  }
};

Eigen::Matrix<double, 3, 2> tangents(const Vec3& n) {
  const Vec3 t = n.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> E;
  E << t, n.cross(t);
  return E;
}

struct Found {
  Vec3 n;
  double gap;
  bool stationary = false;
};

/// Turns n about the unit axis w by the angle at which the gap stops growing: bisection on its slope (w x n).(d - s(n)), which
/// knows the angle to rounding where the gap itself knows it to the root of rounding only. Returns the angle.
double climb_about(const Pair& pair, const Vec3& w, double tolerance, Vec3& n) {
  constexpr double kFirst = 1e-7, kGrowth = 6, kFarthest = 0.5;  // [rad]
  const Vec3 across = w.cross(n), along = w.dot(n) * w;
  auto turned = [&](double angle) -> Vec3 { return math::cos(angle) * (n - along) + math::sin(angle) * across + along; };
  auto slope = [&](double angle) {
    const Vec3 m = turned(angle);
    return w.cross(m).dot(pair.d - pair.support_sum(m));
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

/// One step of Newton on the tangential miss, taken if it halves it. `top`: there is none to take, it is a maximum to rounding.
bool newton(const Pair& pair, Pair::At& at, bool& top) {
  constexpr double kRounding = 2e-14;  // [m]
  top = false;
  const auto E = tangents(at.n);
  const Eigen::Vector2d miss = E.transpose() * (pair.d - at.sum);
  const Eigen::Matrix2d H = E.transpose() * pair.hessian_sum(at) * E + at.gap * Eigen::Matrix2d::Identity();
  if (!(H.determinant() > 0 && H.trace() > 0)) return false;
  top = miss.norm() < kRounding;
  if (top) return false;
  const Eigen::Vector2d step = H.inverse() * miss;
  if (!(step.norm() < 0.1)) return false;
  const Pair::At next = pair.at((at.n + E * step).normalized());
  if ((tangents(next.n).transpose() * (pair.d - next.sum)).norm() > 0.5 * miss.norm()) return false;
  at = next;
  return true;
}

/// Near the flats of n > 2 the support function has all but kinks where n is across a body axis, and the maximum often lies on one:
/// Newton stalls there. Climbs along and across the circles of kinks nearby by turns, each to where the gap stops growing.
Found settle(const Pair& pair, Found at, double tolerance) {
  constexpr double kNearby = 0.3;  // [-] sine of the angle to a kink
  constexpr int kRounds = 200, kAround = 16;
  Vec3 n = at.n;
  for (int round = 0; round < kRounds; ++round) {
    bool top = false;
    for (Pair::At here = pair.at(n); newton(pair, here, top);) n = here.n;
    if (top) break;
    double moved = 0;
    bool kinks = false;
    for (int i = 0; i < 6; ++i) {
      const Vec3 axis = i < 3 ? pair.R_WA.col(i) : pair.R_WB.col(i - 3);
      if (std::abs(n.dot(axis)) > kNearby) continue;
      kinks = true;
      moved = std::max(moved, climb_about(pair, n.cross(axis).normalized(), tolerance, n));
      moved = std::max(moved, climb_about(pair, axis, tolerance, n));
    }
    if (!kinks) {
      const Vec3 t = n.unitOrthogonal();
      moved = std::max(moved, climb_about(pair, t, tolerance, n));
      moved = std::max(moved, climb_about(pair, n.cross(t).normalized(), tolerance, n));
    }
    // two ridges that cross at a slant leave a narrow way up between the directions of both
    for (int k = 0; k < kAround && moved <= 2 * tolerance; ++k) {
      const Vec3 t = n.unitOrthogonal();
      const double turn = std::numbers::pi * k / kAround;
      moved = climb_about(pair, math::cos(turn) * t + math::sin(turn) * n.cross(t), tolerance, n);
    }
    if (moved <= 2 * tolerance) break;
  }
  const double gap = pair.gap(n);
  return gap >= at.gap - 1e-15 ? Found{n, gap, false} : at;
}

constexpr double kCoarse = 1e-4;           // [rad] far enough to tell which of several maxima is the largest
constexpr double kSameHill = 0.99995;      // [-] cosine of 0.6 deg: stalled on the way to the maximum that is known
constexpr double kFine = 2e-11;            // [rad]
constexpr int kSweep = 120;                // directions
constexpr std::size_t kRounds = 7;         // of them are followed
constexpr double kGoldenAngle = 2.399963;  // [rad]

Found climb(const Pair& pair, const Vec3& n, int iterations) {
  constexpr double kStationary = 1e-9;  // [m] of the tangential miss; the gap errs by its square over the radius
  Pair::At at = pair.at(n);
  double damping = 1e-3 * pair.d.norm() + 1e-6;
  for (int k = 0; k < iterations; ++k) {
    const auto E = tangents(at.n);
    const Eigen::Vector2d slope = E.transpose() * (pair.d - at.sum);
    if (slope.norm() < kStationary) return {at.n, at.gap, true};
    const Eigen::Matrix2d H = E.transpose() * pair.hessian_sum(at) * E + at.gap * Eigen::Matrix2d::Identity();
    bool better = false;
    for (int trial = 0; trial < 12 && !better; ++trial) {
      const Eigen::Matrix2d M = H + damping * Eigen::Matrix2d::Identity();
      if (M.determinant() > 0 && M.trace() > 0) {
        Eigen::Vector2d s = M.inverse() * slope;
        if (s.norm() > 0.5) s *= 0.5 / s.norm();
        const Pair::At next = pair.at((at.n + E * s).normalized());
        if (next.gap > at.gap) {
          better = true;
          at = next;
        }
      }
      damping = better ? 0.1 * damping : 8 * damping;
    }
    if (!better) break;
  }
  return {at.n, at.gap, false};
}

/// On a flat side a normal that is right to rounding still leaves open where along the side the surfaces meet: the support point
/// of the rounder of the two tells. Share of the way across from A's point to B's.
double share_across(const Pair& pair, const SurfaceContact& c) {
  constexpr double kSlip = 1e-6;  // [m]
  const Vec3 across = (c.p_b - c.p_a) - (c.p_b - c.p_a).dot(c.normal) * c.normal;
  if (across.norm() < kSlip) return 0.5;
  // how far a support point goes for a small turn of the normal in the direction they are apart
  const Vec3 lean = (c.normal + 1e-6 * across.normalized()).normalized();
  auto travel = [&](const HyperEllipsoid& shape, const Mat3& R_WS) {
    return (support_point(shape, R_WS.transpose() * lean) - support_point(shape, R_WS.transpose() * c.normal)).norm();
  };
  const double a = travel(pair.A, pair.R_WA), b = travel(pair.B, pair.R_WB);
  return a + b > 0 ? a / (a + b) : 0.5;
}

std::optional<SurfaceContact> search(const HyperEllipsoid& A, const Pose& X_WA, const HyperEllipsoid& B, const Pose& X_WB,
                                     double margin, Vec3& normal_guess, double* apart) {
  const Pair pair{A, B, X_WA.q.toRotationMatrix(), X_WB.q.toRotationMatrix(), X_WA.p - X_WB.p};
  const double distance = pair.d.norm();
  const Vec3 towards = distance > 1e-12 ? Vec3(pair.d / distance) : Vec3(Vec3::UnitZ());
  // any direction that separates by more than the margin ends it
  double known = pair.gap(towards);
  if (known < margin && normal_guess.squaredNorm() > 0.5) known = pair.gap(normal_guess);
  if (known >= margin) {
    if (apart) *apart = known;
    return std::nullopt;
  }

  const bool warm = normal_guess.squaredNorm() > 0.5;
  Found best = climb(pair, warm ? normal_guess : towards, 40);
  const bool deep = best.gap < -0.1 * std::min(A.semi_axes.minCoeff(), B.semi_axes.minCoeff());
  if (!warm && !best.stationary) best = settle(pair, best, kCoarse);
  // apart, the gap is concave over directions: a maximum is the only one
  if (best.gap < 0 && (!warm || deep)) {
    auto try_from = [&](const Vec3& n) {
      if (pair.gap(n) < 2 * best.gap - 0.5 * A.semi_axes.maxCoeff()) return;
      Found found = climb(pair, n, 25);
      if (!found.stationary && !warm && found.n.dot(best.n) < kSameHill) found = settle(pair, found, kCoarse);
      if (found.gap > best.gap + 1e-12) best = found;
    };
    if (warm) try_from(towards);
    for (int i = 0; i < 3; ++i)
      for (const Vec3& axis : {Vec3(pair.R_WA.col(i)), Vec3(pair.R_WB.col(i))}) try_from(axis.dot(pair.d) < 0 ? Vec3(-axis) : axis);
    // boxes deep in each other hide maxima from all of these: look around evenly, and try the most promising directions, each away
    // from those tried before
    std::array<Vec3, kRounds + 1> tried;
    tried[0] = best.n;
    for (std::size_t round = 1; round <= kRounds; ++round) {
      const auto tried_end = tried.begin() + static_cast<std::ptrdiff_t>(round);
      Vec3 promising = best.n;
      double promise = -1e300;
      for (int k = 0; k < kSweep; ++k) {
        const double z = 1 - (2 * k + 1.0) / kSweep, turn = kGoldenAngle * k;
        const double r = std::sqrt(1 - z * z);
        const Vec3 n(r * math::cos(turn), r * math::sin(turn), z);
        const double g = pair.gap(n);
        if (g <= promise || std::any_of(tried.begin(), tried_end, [&](const Vec3& t) { return n.dot(t) > 0.9; })) continue;
        promise = g;
        promising = n;
      }
      tried[round] = promising;
      try_from(promising);
    }
    best = climb(pair, best.n, 60);
  }
  if (best.gap < margin) best = settle(pair, best, kFine);
  normal_guess = best.n;
  if (best.gap >= margin) {
    if (apart) *apart = best.gap;
    return std::nullopt;
  }
  SurfaceContact c;
  c.normal = best.n;
  c.gap = best.gap;
  c.p_a = X_WA.p - pair.R_WA * support_point(A, pair.R_WA.transpose() * best.n);
  c.p_b = X_WB.p + pair.R_WB * support_point(B, pair.R_WB.transpose() * best.n);
  c.share_across = share_across(pair, c);
  return c;
}

}  // namespace

std::optional<SurfaceContact> contact_of_pair(const HyperEllipsoid& A, const Pose& X_WA, const HyperEllipsoid& B, const Pose& X_WB,
                                              double margin, Vec3& normal_guess, double* apart) {
  // always the same way round, so that what A gets of B is what B gets of A, to the last bit
  const Vec3 &a = X_WA.p, &b = X_WB.p;
  if (!std::lexicographical_compare(b.data(), b.data() + 3, a.data(), a.data() + 3))
    return search(A, X_WA, B, X_WB, margin, normal_guess, apart);
  Vec3 back = -normal_guess;
  auto contact = search(B, X_WB, A, X_WA, margin, back, apart);
  normal_guess = -back;
  if (contact) {
    contact->normal = -contact->normal;
    std::swap(contact->p_a, contact->p_b);
    contact->share_across = 1 - contact->share_across;
  }
  return contact;
}

}  // namespace engine
