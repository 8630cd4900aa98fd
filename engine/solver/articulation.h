// The joints of a tree of bodies, factorised in tree order: exact whatever the mass ratio, linear in the number of bodies.
//
// To solve   [ M  J^T ] [ a]   [f]
//            [ J   0  ] [-l] = [g]     leaves first, body c on joint (Jc, Jp) with parent p:
//   H_c = M_c + what its children added          A = Jc H_c^-1 Jc^T
//   a_c = X a_p + D f_c + E g                    E = H_c^-1 Jc^T A^-1,  X = -E Jp,  D = H_c^-1 - E Jc H_c^-1
//   H_p += Jp^T A^-1 Jp                          f_p += X^T f_c + F g,  F = Jp^T A^-1
// A damper C between c and p (3x3 on the relative angular velocity, times the step) couples the two: with B = -C in the angular
// block, H_c and H_p gain C, Jp becomes Jp - Jc H_c^-1 B, X gains -H_c^-1 B and H_p loses B^T H_c^-1 B.
// The inverse seen between bodies follows from X and D alone: W_ii = D_i + X_i W_pp X_i^T, W_ij = X_i W_pj (response.h).
#pragma once

#include <vector>

#include "engine/solver/joint_rows.h"
#include "engine/solver/topology.h"

namespace engine {

/// Implicit resistance of one joint over a step: `matrix` (world, symmetric, >= 0) [kg m^2] as if added to the inertia.
struct JointDamper {
  Mat3 matrix = Mat3::Zero();
  bool present = false;
};

class Articulation {
 public:
  explicit Articulation(const Model&);
  void reset(const Topology&);

  /// Factorises one tree at the poses given. `dampers` (per joint) may be null.
  void factor(const Topology&, int tree, const std::vector<Pose>& X_WB, const std::vector<JointDamper>* dampers);

  /// Right-hand side g = -Jdot V of every joint of the tree. Call after factor.
  void set_bias(const Topology&, int tree, const std::vector<Pose>& X_WB, const std::vector<Twist>& V_WB);

  /// Solves for one tree: f (per body) is used up, a receives the result; `bias` says whether g is rows.bias or zero.
  enum class Bias { zero, from_rows };
  void solve(const Topology&, int tree, std::vector<Vec6>& f, std::vector<Vec6>& a, Bias) const;

  struct Factor {
    JointRows rows;
    Mat6 X, D, E, F;  // E, F: first rows.count columns
  };
  Factor& of_link(int link) { return factors_[link]; }
  const Factor& of_link(int link) const { return factors_[link]; }

 private:
  template <int K>
  void eliminate(Factor&, const Mat6& J_c, const Mat6& J_p, const Mat6& H, Mat6* H_parent, const JointDamper*);

  void eliminate_point(Factor&, double sign, const Mat3& C, const Mat3& P, const Mat6& H, Mat6* H_parent);

  const Model& model_;
  std::vector<Factor> factors_;  // per link
  std::vector<Mat6> H_;          // per body
};

/// Inverse of a symmetric positive definite 6x6 by 3x3 blocks.
Mat6 inverse_spd(const Mat6&);

/// Inertia of a body about its centre in world axes.
Mat3 inertia_W(const Body&, const Quat& q_WB);

}  // namespace engine
