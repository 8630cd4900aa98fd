// The joints of a tree of bodies, factorised in tree order: exact whatever the mass ratio, linear in the number of bodies.
//
// To solve   [ M  J^T ] [ a]   [f]
//            [ J   0  ] [-l] = [g]     leaves first, each body with its own joint, S its motion subspace (joints/rows.h):
//   a_c = X0 a_p + S z + c       X0 carries the parent's motion to c as if the joint were locked, c gives the rows their bias g
//   H_c = M_c + what its children added,  K = S^T H_c S,  D = S K^-1 S^T
//   a_c = X a_p + D f_c + c,     X = X0 - D H_c X0,  with f_c - H_c c for f_c
//   H_p += X0^T H_c X            f_p += X^T f_c
// after Featherstone (1983). What is inverted is K, over the joint's freedoms, and never the inertia of a light body.
// A damper C between c and p (on the relative velocity at the joint's point, times the step) adds S^T C S to K.
// How bodies answer each other follows from X and D alone: W_ii = D_i + X_i W_pp X_i^T, W_ij = X_i W_pj: see response.h.
#pragma once

#include <vector>

#include "engine/joints/rows.h"
#include "engine/solver/topology.h"

namespace engine {

/// Implicit resistance of one joint over a step (world, symmetric, >= 0), as if added to the inertia.
struct JointDamper {
  Mat3 turning = Mat3::Zero();  // [kg m^2]
  Mat3 sliding = Mat3::Zero();  // [kg]
  bool present = false;
};

class Articulation {
 public:
  explicit Articulation(const Model&);
  void reset(const Topology&);

  /// The rows of a link's joint, and the inertia of its body in world axes, where the bodies stand so. What was asked for last is
  /// kept: an attempt at a step asks at the same place for its first stage, its resistance and its energy.
  JointRows& rows_at(const Topology&, int link, const std::vector<Pose>& X_WB);
  const Mat3& inertia_at(const Topology&, int link, const Quat& q_WB);

  /// Factorises one tree at the poses given. `dampers` (per joint) may be null.
  void factor(const Topology&, int tree, const std::vector<Pose>& X_WB, const std::vector<JointDamper>* dampers);

  /// The same without dampers, unless those are the factors the tree has.
  void factor_unless_known(const Topology&, int tree, const std::vector<Pose>& X_WB);
  /// Takes over all factors of another, which knows none from then on.
  void take_over(Articulation& other);

  /// Right-hand side g = -Jdot V of every joint of the tree. Call after factor.
  void set_bias(const Topology&, int tree, const std::vector<Twist>& V_WB);

  /// Solves for one tree: f (per body) is used up, a receives the result; `bias` says whether g is rows.bias or zero.
  enum class Bias { zero, from_rows };
  void solve(const Topology&, int tree, std::vector<Vec6>& f, std::vector<Vec6>& a, Bias) const;

  struct Factor {
    JointRows rows;
    Mat6 X, D;
  };
  Factor& of_link(int link) { return factors_[link]; }
  const Factor& of_link(int link) const { return factors_[link]; }

 private:
  /// What one joint is to the factorisation: levers and sense seen from the body that is eliminated.
  struct Hinge {
    const Vec3& r;         // [m] from the body's centre to the joint's point
    const Vec3& r_parent;  // [m] from its parent's
    const JointDamper* damper;
  };
  static Mat6 locked(const Hinge&);
  void eliminate_cross(Factor&, const Hinge&, const Mat6& H, Mat6* H_parent);
  void eliminate_slide(Factor&, const Hinge&, const Mat6& H, Mat6* H_parent);
  void eliminate_any(Factor&, const Hinge&, const Mat6& H, Mat6* H_parent);
  void eliminate_fixed(Factor&, const Hinge&, const Mat6& H, Mat6* H_parent);

  const Model& model_;
  std::vector<Factor> factors_;  // per link
  std::vector<Mat6> H_;          // per link: inertia with what its children added
  std::vector<char> undamped_;   // per tree: its factors are where its rows are, without dampers
  /// Where rows and inertia were asked for last.
  struct Place {
    bool rows = false, turned = false;  // asked for at all
    Pose X_WP, X_WC;
    Quat q_WB;
    Mat3 inertia;
  };
  std::vector<Place> places_;  // per link
};

/// Inertia of a body about its centre in world axes.
Mat3 inertia_W(const Body&, const Quat& q_WB);

}  // namespace engine
