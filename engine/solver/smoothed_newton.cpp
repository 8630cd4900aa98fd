// Newton on the conditions smoothed, for islands in which sweeps and semi-smooth Newton go round in circles: a limb wedged between
// vehicles, a bicycle between a car and the road.
//
// Each condition is Fischer and Burmeister's function of impulse and velocity on its cone, x + z - (x^2 + z^2 + 2 eps^2)^(1/2) = 0
// (Fukushima, Luo and Tseng 2002), whose solution is unique and smooth as long as eps > 0 and slip does not change the normal
// condition much. It is followed from a large eps, where every contact is half open and half slipping, towards zero.
#include <algorithm>
#include <cmath>

#include "engine/solver/contact_solver.h"
#include "engine/solver/one_contact.h"

namespace engine {
namespace {

constexpr double kMostSmoothing = 10;     // [m/s]
constexpr double kLeastSmoothing = 1e-4;  // [-] of the tolerance

/// What is left [m/s] of a condition, and how it follows the velocity there and its own impulse.
struct Smoothed {
  Vec3 left = Vec3::Zero();
  Mat3 by_u = Mat3::Zero(), by_impulse = Mat3::Zero();
};

/// Product with x in the algebra of the second-order cone, as a matrix.
Mat3 arrow(const Vec3& x) {
  Mat3 out = x[0] * Mat3::Identity();
  out.row(0).tail<2>() = x.tail<2>().transpose();
  out.col(0).tail<2>() = x.tail<2>();
  return out;
}

/// Square root in that algebra of what has no eigenvalue below `least`, and the inverse of its product matrix.
struct ConeRoot {
  Vec3 root;
  Mat3 inverse;
};
ConeRoot cone_root(const Vec3& square, double least) {
  const double across = length_of(square[1], square[2]);
  const double s1 = std::sqrt(std::max(least, square[0] - across)), s2 = std::sqrt(std::max(least, square[0] + across));
  const Eigen::Vector2d direction = across > 0 ? Eigen::Vector2d(square.tail<2>() / across) : Eigen::Vector2d(1, 0);
  ConeRoot out;
  const double w0 = 0.5 * (s1 + s2);
  const Eigen::Vector2d w = 0.5 * (s2 - s1) * direction;
  out.root << w0, w;
  out.inverse(0, 0) = w0;
  out.inverse.row(0).tail<2>() = -w.transpose();
  out.inverse.col(0).tail<2>() = -w;
  out.inverse.bottomRightCorner<2, 2>() = (s1 * s2 * Eigen::Matrix2d::Identity() + w * w.transpose()) / w0;
  out.inverse /= s1 * s2;
  return out;
}

/// Of one row: impulse and velocity beyond the target are not negative, and one of them is zero.
void smooth_row(const Constraint& c, double A, double miss, double eps, Smoothed& out) {
  const double a = A + c.softness;
  const double x = a * c.impulse[0], z = miss;
  const double root = std::sqrt(x * x + z * z + 2 * eps * eps);
  out.left[0] = x + z - root;
  out.by_u(0, 0) = 1 - z / root;
  out.by_impulse(0, 0) = out.by_u(0, 0) * c.softness + (1 - x / root) * a;
}

/// In the road plane a wheel has its own law, which has no cone: the derivatives by differences.
void smooth_tread(const Constraint& c, const Mat3& A, const Vec3& u, Smoothed& out) {
  constexpr double kShare = 1e-7, kSpeed = 1e-3, kImpulse = 1e-2;  // [-], [m/s], [N s]
  const Eigen::Vector2d scale(A(1, 1), A(2, 2) + c.wheel.grip_softness);
  const Vec3 law = solve_wheel(A, u, c.impulse, c);
  out.left.tail<2>() = scale.cwiseProduct((c.impulse - law).tail<2>());
  out.by_impulse.bottomRightCorner<2, 2>() = scale.asDiagonal();
  for (int q = 0; q < 3; ++q) {
    Vec3 moved = u;
    moved[q] += kShare * std::max(kSpeed, std::abs(u[q]));
    out.by_u.col(q).tail<2>() = -scale.cwiseProduct((solve_wheel(A, moved, c.impulse, c) - law).tail<2>()) / (moved[q] - u[q]);
    moved = c.impulse;
    moved[q] += kShare * std::max(kImpulse, std::abs(moved[q]));
    out.by_impulse.col(q).tail<2>() -=
        scale.cwiseProduct((solve_wheel(A, u, moved, c) - law).tail<2>()) / (moved[q] - c.impulse[q]);
  }
}

/// Coulomb's cone as de Saxce has it: the normal velocity with mu times the slip is of the dual cone, at a right angle to the
/// impulse.
void smooth_contact(const Constraint& c, const Mat3& A, const Vec3& u, double miss, double eps, Smoothed& out) {
  const double mu = c.surface.friction, a = A.trace() / 3;
  const double slip = std::sqrt(u[1] * u[1] + u[2] * u[2] + eps * eps);
  const Vec3 x = a * Vec3(mu * c.impulse[0], c.impulse[1], c.impulse[2]);
  const Vec3 z(miss + mu * (slip - eps), mu * u[1], mu * u[2]);
  const auto square = [](const Vec3& v) { return Vec3(v.squaredNorm(), 2 * v[0] * v[1], 2 * v[0] * v[2]); };
  Vec3 sum = square(x) + square(z);
  sum[0] += 2 * eps * eps;
  const ConeRoot w = cone_root(sum, 2 * eps * eps);
  out.left = x + z - w.root;
  const Mat3 by_x = Mat3::Identity() - w.inverse * arrow(x), by_z = Mat3::Identity() - w.inverse * arrow(z);
  Mat3 z_by_u = Vec3(1, mu, mu).asDiagonal();
  z_by_u(0, 1) = mu * u[1] / slip;
  z_by_u(0, 2) = mu * u[2] / slip;
  out.by_u = by_z * z_by_u;
  out.by_impulse = a * by_x * Vec3(mu, 1, 1).asDiagonal();
  out.by_impulse.col(0) += c.softness * by_z.col(0);
}

Smoothed smoothed(const Constraint& c, const Mat3& A, const Vec3& u, double eps) {
  Smoothed out;
  const double miss = u[0] + c.softness * c.impulse[0] - c.target;
  switch (c.kind) {
    case ConstraintKind::bilateral:
      out.left[0] = miss;
      out.by_u(0, 0) = 1;
      out.by_impulse(0, 0) = c.softness;
      break;
    case ConstraintKind::limit: {
      const double arm = c.slides ? 1.0 : kLimitArm;
      smooth_row(c, A(0, 0), miss, eps / arm, out);
      out.left *= arm, out.by_u *= arm, out.by_impulse *= arm;
      break;
    }
    case ConstraintKind::wheel:
      smooth_tread(c, A, u, out);
      smooth_row(c, A(0, 0), miss, eps, out);
      break;
    case ConstraintKind::contact:
      if (c.surface.friction > 0) {
        smooth_contact(c, A, u, miss, eps, out);
      } else {
        smooth_row(c, A(0, 0), miss, eps, out);
        for (int r = 1; r < 3; ++r) out.left[r] = A(r, r) * c.impulse[r], out.by_impulse(r, r) = A(r, r);
      }
      break;
  }
  return out;
}

}  // namespace

/// One step to the solution of the smoothed conditions made linear; false if there is none.
bool ContactSolver::smoothed_step(std::vector<Constraint>& all, const std::vector<int>& members, double eps) {
  newton_.resize(size_);
  for (int i = 0; i < static_cast<int>(members.size()); ++i) {
    const Constraint& c = all[members[i]];
    const Smoothed s = smoothed(c, own_[i], velocity(i, c.rows), eps);
    const int at = offset_[i];
    for (int m = 0; m < size_; ++m) {
      const double* response = G_.data() + static_cast<std::size_t>(m) * stride_ + at;
      double* column = newton_.column(m) + at;
      for (int r = 0; r < c.rows; ++r) {
        column[r] = 0;
        for (int q = 0; q < c.rows; ++q) column[r] += s.by_u(r, q) * response[q];
      }
    }
    for (int r = 0; r < c.rows; ++r) {
      for (int q = 0; q < c.rows; ++q) newton_.A(at + r, at + q) += s.by_impulse(r, q);
      newton_.b(at + r) = -s.left[r];
    }
  }
  if (!newton_.factor()) return false;
  newton_.solve();
  for (int i = 0; i < static_cast<int>(members.size()); ++i) {
    Constraint& c = all[members[i]];
    Vec3 change = Vec3::Zero();
    for (int r = 0; r < c.rows; ++r) change[r] = newton_.b(offset_[i] + r);
    c.impulse += change;
    add_to_velocity(i, c.rows, change);
  }
  return true;
}

/// Full steps, each with sharper conditions than the last, by the factor `sharper`; the best of them is kept. A search along the
/// steps, or waiting until one smoothing is solved, finds fewer solutions: it comes to rest where a wheel's law has a kink.
void ContactSolver::follow_smoothing(std::vector<Constraint>& all, const std::vector<int>& members, double tolerance,
                                     double sharper, SolveReport& report) {
  report.residual = residual(all, members);
  keep(all, members);
  double best = report.residual;
  for (double eps = std::min(report.residual, kMostSmoothing); eps > kLeastSmoothing * tolerance && best > tolerance;
       eps *= sharper) {
    if (!smoothed_step(all, members, eps)) break;
    ++report.newton_steps;
    report.residual = residual(all, members);
    if (!std::isfinite(report.residual)) break;
    if (report.residual < best) best = report.residual, keep(all, members);
  }
  go_back(all, members);
  // smoothed conditions are held a little beyond the cones: who is open has no impulse at all
  for (int i = 0; i < static_cast<int>(members.size()); ++i) {
    Constraint& c = all[members[i]];
    Vec3 within = c.impulse;
    if (c.kind == ConstraintKind::contact) within = project_to_cone(within, c.surface.friction);
    if (c.kind != ConstraintKind::bilateral) within[0] = std::max(0.0, within[0]);
    add_to_velocity(i, c.rows, within - c.impulse);
    c.impulse = within;
  }
  report.residual = residual(all, members);
}

}  // namespace engine
