// The common normal maximises the signed gap   g(n) = n.(c_A - c_B) - h_A(n) - h_B(n)   over unit n (from B to A): where it is
// stationary the tangent planes are parallel and (c_A - c_B) - s(n) is along n, the source's (75), (76). Apart, g is concave and
// its maximum the distance; overlapping, the largest maximum is the least depth and there can be several, so the search starts from
// many directions. g at any n is a lower bound of the gap and second order in the error of n: gap and points always come from
// g at the final n. Newton on the sphere: (E^T (H_A + H_B) E + g 1 + mu 1) s = E^T ((c_A - c_B) - s(n)), mu as in
// Levenberg-Marquardt.
#include "engine/geometry/hyper_ellipsoid_pair.h"

#include <Eigen/LU>
#include <cmath>

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
  Mat3 hessian_sum(const Vec3& n) const {
    return R_WA * support_hessian(A, R_WA.transpose() * n) * R_WA.transpose() +
           R_WB * support_hessian(B, R_WB.transpose() * n) * R_WB.transpose();
  }
};

struct Found {
  Vec3 n;
  double gap;
  bool stationary = false;
};

/// Near the flats of n > 2 the support function has all but kinks where n is across a body axis, and the maximum often lies on one:
/// Newton stalls there. Steps along and across the six circles of kinks, halved until nothing is gained.
/// With a guess from the last step at hand only the kinks nearby are tried.
Found polish(const Pair& pair, Found at, bool warm) {
  constexpr double kFirstStep = 0.02, kLastStep = 1e-9, kLastWarmStep = 1e-8;  // [rad]
  const double nearby = warm ? 0.2 : 2.0;                                      // [-] sine of the angle to a kink
  for (double step = kFirstStep; step > (warm ? kLastWarmStep : kLastStep); step *= 0.5) {
    for (int round = 0; round < 8; ++round) {
      bool better = false;
      for (int i = 0; i < 6; ++i) {
        const Vec3 axis = i < 3 ? pair.R_WA.col(i) : pair.R_WB.col(i - 3);
        if (std::abs(at.n.dot(axis)) > nearby) continue;
        const Vec3 along = at.n.cross(axis);
        if (along.squaredNorm() < 1e-12) continue;
        const Vec3 t = along.normalized();
        for (const Vec3& direction : {t, Vec3(-t), Vec3(at.n.cross(t)), Vec3(-at.n.cross(t))}) {
          const Vec3 next = (at.n + step * direction).normalized();
          const double gap = pair.gap(next);
          if (gap <= at.gap + 1e-15) continue;
          at = {next, gap, false};
          better = true;
        }
        // right onto the kink, when it is near
        const Vec3 onto = (at.n - at.n.dot(axis) * axis).normalized();
        if (std::abs(at.n.dot(axis)) < 4 * step) {
          const double gap = pair.gap(onto);
          if (gap > at.gap) {
            at = {onto, gap, false};
            better = true;
          }
        }
      }
      if (!better) break;
    }
  }
  return at;
}

constexpr int kSweep = 48;                 // directions
constexpr double kGoldenAngle = 2.399963;  // [rad]

Found climb(const Pair& pair, Vec3 n, int iterations) {
  constexpr double kStationary = 1e-9;  // [m] of the tangential miss; the gap errs by its square over the radius
  double g = pair.gap(n);
  double damping = 1e-3 * pair.d.norm() + 1e-6;
  for (int k = 0; k < iterations; ++k) {
    const Vec3 t1 = n.unitOrthogonal();
    Eigen::Matrix<double, 3, 2> E;
    E << t1, n.cross(t1);
    const Eigen::Vector2d slope = E.transpose() * (pair.d - pair.support_sum(n));
    if (slope.norm() < kStationary) return {n, g, true};
    const Eigen::Matrix2d H = E.transpose() * pair.hessian_sum(n) * E + g * Eigen::Matrix2d::Identity();
    bool better = false;
    for (int trial = 0; trial < 12 && !better; ++trial) {
      const Eigen::Matrix2d M = H + damping * Eigen::Matrix2d::Identity();
      if (M.determinant() > 0 && M.trace() > 0) {
        Eigen::Vector2d s = M.inverse() * slope;
        if (s.norm() > 0.5) s *= 0.5 / s.norm();
        const Vec3 next = (n + E * s).normalized();
        const double g_next = pair.gap(next);
        if (g_next > g) {
          better = true;
          n = next;
          g = g_next;
        }
      }
      damping = better ? 0.1 * damping : 8 * damping;
    }
    if (!better) break;
  }
  return {n, g, false};
}

}  // namespace

std::optional<SurfaceContact> contact_of_pair(const HyperEllipsoid& A, const Pose& X_WA, const HyperEllipsoid& B, const Pose& X_WB,
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
  if (!warm || deep) {
    auto try_from = [&](const Vec3& n) {
      if (pair.gap(n) < 2 * best.gap - 0.5 * A.semi_axes.maxCoeff()) return;
      Found found = climb(pair, n, 25);
      if (!found.stationary && !warm) found = polish(pair, found, false);
      if (found.gap > best.gap + 1e-12) best = found;
    };
    if (warm) try_from(towards);
    for (int i = 0; i < 3; ++i)
      for (const Vec3& axis : {Vec3(pair.R_WA.col(i)), Vec3(pair.R_WB.col(i))}) try_from(axis.dot(pair.d) < 0 ? Vec3(-axis) : axis);
    // boxes deep in each other hide maxima from all of these: look around once more, evenly
    for (int round = 0; round < 3; ++round) {
      Vec3 promising = best.n;
      double promise = -1e300;
      for (int k = 0; k < kSweep; ++k) {
        const double z = 1 - (2 * k + 1.0) / kSweep, turn = kGoldenAngle * k + round;
        const double r = std::sqrt(1 - z * z);
        const Vec3 n(r * std::cos(turn), r * std::sin(turn), z);
        const double g = pair.gap(n);
        if (g > promise && n.dot(best.n) < 0.9) {
          promise = g;
          promising = n;
        }
      }
      try_from(promising);
    }
    best = climb(pair, best.n, 60);
  }
  if (!best.stationary && best.gap < margin) best = polish(pair, best, warm && !deep);
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
  return c;
}

}  // namespace engine
