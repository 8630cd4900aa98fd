// Impulses of all contacts, limits and wheels of an island at once: Signorini's condition and the exact Coulomb cone, eq. (61).
//
//   u = G L + u_free,   u_n + s L_n >= t,  L_n >= 0,  L_n (u_n + s L_n - t) = 0,   |L_t| <= mu L_n, L_t against u_t
// G = J K^-1 J^T through the joint factorisation (eq. (63) with K for M), s softness, t target. Block Gauss-Seidel, each contact
// solved exactly for given others: open, stick, or slip along the direction c that its own slip then has (Newton on c, no
// trigonometry).
#pragma once

#include <vector>

#include "engine/solver/constraint.h"
#include "engine/solver/response.h"

namespace engine {

struct SolveReport {
  int sweeps = 0;
  double residual = 0;  // [m/s] natural map, largest over the blocks
};

class ContactSolver {
 public:
  /// Builds G for the constraints named. Their rows and bodies must be set.
  void assemble(const Topology&, const Response&, const std::vector<Constraint>&, const std::vector<int>& members);

  /// Solves; impulses of the constraints are start value and result, u_after is set. `tolerance` [m/s].
  SolveReport solve(std::vector<Constraint>&, const std::vector<int>& members, double tolerance, int max_sweeps);

  /// Change of kinetic energy [J] by the impulses: L.u_after - 1/2 L.G L.
  double kinetic_energy_change(const std::vector<Constraint>&, const std::vector<int>& members) const;

 private:
  void add_to_velocity(int column, int rows, const Vec3& change);

  int size_ = 0;
  std::vector<int> offset_;  // per member
  std::vector<double> G_;    // column-major size_ x size_
  std::vector<double> u_;
  std::vector<Eigen::Matrix<double, 3, 6>> Y_;
};

/// Exact impulse of one contact with own response A (3x3), velocity b without it, normal target t and softness s (already in A).
/// `guess` is the last impulse: its tangential part starts the search for the direction of slip.
Vec3 solve_one_contact(const Mat3& A, const Vec3& b, double target, double mu, const Vec3& guess);

/// Nearest point of the cone |L_t| <= mu L_n.
Vec3 project_to_cone(const Vec3& impulse, double mu);

}  // namespace engine
