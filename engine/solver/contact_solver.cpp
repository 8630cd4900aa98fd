#include "engine/solver/contact_solver.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace engine {
namespace {

constexpr int kPatience = 50;      // sweeps at full length
constexpr double kShorter = 0.5;   // [-] of the change afterwards
constexpr double kLimitArm = 0.3;  // [m] turns the speed of a joint limit into that of a limb's end, to compare residuals

Vec3 solve_wheel(const Mat3& A, const Vec3& u, const Vec3& old, const Constraint& c) {
  // normal first, then the ground plane: rolling direction bounded by the brake, both by the friction circle
  const double normal = std::max(0.0, old[0] + (c.target - u[0] - c.softness * old[0]) / (A(0, 0) + c.softness));
  const Vec3 u1 = u + A.col(0) * (normal - old[0]);
  const double det = A(1, 1) * A(2, 2) - A(1, 2) * A(2, 1);
  double x = old[1] - (A(2, 2) * u1[1] - A(1, 2) * u1[2]) / det;
  double y = old[2] - (A(1, 1) * u1[2] - A(2, 1) * u1[1]) / det;
  if (std::abs(x) > c.rolling_bound) {
    x = std::copysign(c.rolling_bound, x);
    y = old[2] - (u1[2] + A(2, 1) * (x - old[1])) / A(2, 2);
  }
  const double most = c.friction * normal;
  const double length = std::hypot(x, y);
  if (length > most && std::abs(x) >= c.rolling_bound && c.rolling_bound < most) {
    // the brake has its share first: a rolling wheel keeps turning, what grip is left holds sideways
    y = std::copysign(std::sqrt(most * most - x * x), y);
  } else if (length > most) {
    const double scale = most / length;
    x *= scale;
    y *= scale;
  }
  return {normal, x, y};
}

double natural_residual(const Constraint& c, const Vec3& u, const Mat3& A) {
  const double a = A(0, 0) + c.softness;
  const double miss = u[0] + c.softness * c.impulse[0] - c.target;
  switch (c.kind) {
    case ConstraintKind::bilateral:
      return std::abs(miss);
    case ConstraintKind::limit:
      return kLimitArm * std::abs(c.impulse[0] - std::max(0.0, c.impulse[0] - miss / a)) * a;
    case ConstraintKind::wheel: {
      // the soft normal answers to the suspension, the road plane to the tyre: each by its own response
      const Vec3 change = solve_wheel(A, u, c.impulse, c) - c.impulse;
      return std::max(std::abs(change[0]) * a, std::hypot(change[1] * A(1, 1), change[2] * A(2, 2)));
    }
    case ConstraintKind::contact:
      break;
  }
  const double rho = 1 / A.diagonal().maxCoeff();
  const double slip = std::hypot(u[1], u[2]);
  const Vec3 moved = c.impulse - rho * Vec3(miss + c.friction * slip, u[1], u[2]);
  return (c.impulse - project_to_cone(moved, c.friction)).norm() / rho;
}

}  // namespace

Vec3 project_to_cone(const Vec3& impulse, double mu) {
  const double tangential = std::hypot(impulse[1], impulse[2]);
  if (tangential <= mu * impulse[0]) return impulse;
  if (mu * tangential <= -impulse[0]) return Vec3::Zero();
  const double normal = (impulse[0] + mu * tangential) / (1 + mu * mu);
  const double scale = tangential > 0 ? mu * normal / tangential : 0;
  return {normal, scale * impulse[1], scale * impulse[2]};
}

Vec3 solve_one_contact(const Mat3& A, const Vec3& b, double target, double mu, const Vec3& guess) {
  if (b[0] >= target) return Vec3::Zero();
  const Vec3 stick = A.inverse() * Vec3(target - b[0], -b[1], -b[2]);
  if (stick[0] >= 0 && std::hypot(stick[1], stick[2]) <= mu * stick[0]) return stick;
  if (mu <= 0) return {(target - b[0]) / A(0, 0), 0, 0};

  // slip along c: L = L_n (1, -mu c); wanted p.u_t = 0 with p across c, and c.u_t >= 0
  Eigen::Vector2d c(-guess[1], -guess[2]);
  if (c.squaredNorm() < 1e-300) c = Eigen::Vector2d(-stick[1], -stick[2]);
  if (c.squaredNorm() < 1e-300) c = Eigen::Vector2d(1, 0);
  c.normalize();
  const Eigen::Vector2d A_nt(A(0, 1), A(0, 2));
  const Eigen::Matrix2d A_tt = A.bottomRightCorner<2, 2>();
  Vec3 impulse = Vec3::Zero();
  for (int k = 0; k < 8; ++k) {
    const double den = A(0, 0) - mu * A_nt.dot(c);
    if (den <=
        1e-12 * A(0, 0)) {  // Painleve: no slip of this direction can hold the target; take the sticking impulse cut to the cone
      return project_to_cone(stick, mu);
    }
    const double normal = (target - b[0]) / den;
    impulse = Vec3(normal, -mu * normal * c[0], -mu * normal * c[1]);
    const Eigen::Vector2d u_t = b.tail<2>() + A_nt * normal + A_tt * impulse.tail<2>();
    const double size = u_t.norm();
    if (size < 1e-14) break;
    const Eigen::Vector2d p(-c[1], c[0]);
    const double across = p.dot(u_t), along = c.dot(u_t);
    if (along > 0 && std::abs(across) <= 1e-11 * size) break;
    const double d_normal = normal * mu * A_nt.dot(p) / den;
    const Eigen::Vector2d d_u = A_nt * d_normal - mu * (A_tt * (d_normal * c + normal * p));
    const double slope = p.dot(d_u) - along;
    if (along < 0 || slope >= 0) {
      c = (c + u_t / size).squaredNorm() > 1e-6 ? Eigen::Vector2d((c + u_t / size).normalized()) : p;
      continue;
    }
    c = (c + std::clamp(-across / slope, -0.7, 0.7) * p).normalized();
  }
  return impulse;
}

void ContactSolver::assemble(const Topology& topology, const Response& response, const std::vector<Constraint>& all,
                             const std::vector<int>& members) {
  const int count = static_cast<int>(members.size());
  offset_.resize(count);
  size_ = 0;
  for (int i = 0; i < count; ++i) {
    offset_[i] = size_;
    size_ += all[members[i]].rows;
  }
  G_.assign(static_cast<std::size_t>(size_) * size_, 0.0);
  u_.resize(size_);

  const std::vector<int>& bodies = response.touched();
  Y_.resize(topology.tree_of_body.size());
  for (int i = 0; i < count; ++i) {
    const Constraint& ci = all[members[i]];
    // Y_t = rows of i through the joints to body t
    for (const int t : bodies) {
      const int tree = topology.tree_of_body[t];
      const bool via_a = ci.body_a >= 0 && topology.tree_of_body[ci.body_a] == tree;
      const bool via_b = ci.body_b >= 0 && topology.tree_of_body[ci.body_b] == tree;
      Y_[t].setZero();
      if (via_a) Y_[t].noalias() += ci.J_a * response.between(topology, ci.body_a, t);
      if (via_b) Y_[t].noalias() += ci.J_b * response.between(topology, ci.body_b, t);
    }
    for (int k = 0; k <= i; ++k) {
      const Constraint& ck = all[members[k]];
      Mat3 g = Mat3::Zero();
      if (ck.body_a >= 0) g.noalias() += Y_[ck.body_a] * ck.J_a.transpose();
      if (ck.body_b >= 0) g.noalias() += Y_[ck.body_b] * ck.J_b.transpose();
      for (int r = 0; r < ci.rows; ++r)
        for (int q = 0; q < ck.rows; ++q) {
          G_[static_cast<std::size_t>(offset_[k] + q) * size_ + offset_[i] + r] = g(r, q);
          G_[static_cast<std::size_t>(offset_[i] + r) * size_ + offset_[k] + q] = g(r, q);
        }
    }
  }
}

void ContactSolver::add_to_velocity(int column, int rows, const Vec3& change) {
  for (int q = 0; q < rows; ++q) {
    const double d = change[q];
    if (d == 0) continue;
    const double* g = G_.data() + static_cast<std::size_t>(column + q) * size_;
    for (int r = 0; r < size_; ++r) u_[r] += g[r] * d;
  }
}

SolveReport ContactSolver::solve(std::vector<Constraint>& all, const std::vector<int>& members, double tolerance, int max_sweeps) {
  const int count = static_cast<int>(members.size());
  for (int i = 0; i < count; ++i)
    for (int r = 0; r < all[members[i]].rows; ++r) u_[offset_[i] + r] = all[members[i]].u_free[r];
  for (int i = 0; i < count; ++i) add_to_velocity(offset_[i], all[members[i]].rows, all[members[i]].impulse);

  auto own = [&](int i) {
    Mat3 A = Mat3::Identity();
    const int rows = all[members[i]].rows;
    for (int q = 0; q < rows; ++q)
      for (int r = 0; r < rows; ++r) A(r, q) = G_[static_cast<std::size_t>(offset_[i] + q) * size_ + offset_[i] + r];
    return A;
  };
  auto velocity = [&](int i) {
    Vec3 u = Vec3::Zero();
    for (int r = 0; r < all[members[i]].rows; ++r) u[r] = u_[offset_[i] + r];
    return u;
  };

  SolveReport report;
  for (report.sweeps = 1; report.sweeps <= max_sweeps; ++report.sweeps) {
    double largest = 0;
    for (int i = 0; i < count; ++i) {
      Constraint& c = all[members[i]];
      const Mat3 A = own(i);
      const Vec3 u = velocity(i);
      Vec3 next = Vec3::Zero();
      double scale = 1;
      switch (c.kind) {
        case ConstraintKind::contact: {
          Mat3 soft = A;
          soft(0, 0) += c.softness;
          const Vec3 b = u - A * c.impulse;
          next = solve_one_contact(soft, b, c.target, c.friction, c.impulse);
          break;
        }
        case ConstraintKind::wheel:
          next = solve_wheel(A, u, c.impulse, c);
          break;
        case ConstraintKind::limit:
        case ConstraintKind::bilateral: {
          next[0] = c.impulse[0] + (c.target - u[0] - c.softness * c.impulse[0]) / (A(0, 0) + c.softness);
          if (c.kind == ConstraintKind::limit) {
            next[0] = std::max(0.0, next[0]);
            scale = kLimitArm;
          }
          break;
        }
      }
      // contacts that chase each other between slip and stick come together with shorter steps; the cone is convex, so they stay in
      // it
      if (report.sweeps > kPatience) next = c.impulse + kShorter * (next - c.impulse);
      const Vec3 change = next - c.impulse;
      if (change.squaredNorm() == 0) continue;
      add_to_velocity(offset_[i], c.rows, change);
      c.impulse = next;
      largest = std::max(largest, scale * (A * change).cwiseAbs().maxCoeff());
    }
    if (largest < tolerance) break;
  }
  for (int i = 0; i < count; ++i) {
    Constraint& c = all[members[i]];
    c.u_after = velocity(i);
    report.residual = std::max(report.residual, natural_residual(c, c.u_after, own(i)));
  }
  return report;
}

double ContactSolver::kinetic_energy_change(const std::vector<Constraint>& all, const std::vector<int>& members) const {
  double change = 0;
  for (const int m : members) {
    const Constraint& c = all[m];
    for (int r = 0; r < c.rows; ++r) change += c.impulse[r] * 0.5 * (c.u_after[r] + c.u_free[r]);
  }
  return change;
}

}  // namespace engine
