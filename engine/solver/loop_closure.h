// Joints that close a loop, solved with the factorisation of the trees they were cut from.
//
//   K a = f + J^T l,   J a = g     with K the factorised trees and J the rows of the cut joints
//   G l = g - J a0,    a0 = K^-1 f,   G = J K^-1 J^T     (Delassus matrix, response.h)
// One dense block over all cut joints. G is singular where rows ask for what others hold already (two hinges on one axis; a planar
// four-bar) and where a mechanism stands in a singular position (stretched). So a proximal term is added and taken back by
// iteration:
//   (G + e) dl = r - G l,   l += dl
// which tends to the solution of least squares (Carpentier, Budhiraja and Mansard 2021). What G answers by less than e stays put:
// through a singular position the motion goes on as it came.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "engine/solver/response.h"

namespace engine {

class LoopClosure {
 public:
  explicit LoopClosure(const Model&);
  void reset(const Topology&);

  /// The cut joints that hold now: not broken, and no body of theirs asleep.
  void choose(const Topology&, const std::vector<char>& broken, const std::vector<char>& awake);
  bool any() const { return !joints_.empty(); }
  const std::vector<int>& joints() const { return joints_; }
  /// Their trees, ascending, and whether a tree is one of them.
  const std::vector<int>& trees() const { return trees_; }
  bool holds(int tree) const { return held_tree_[tree] != 0; }

  /// Rows and error at the poses given; returns the largest error [m], [-], and raises `largest_gap` [m].
  double place(const std::vector<Pose>& X_WB, double& largest_gap);
  /// Factorises G at the rows placed last, from factors of the trees at the same poses.
  void factor(const Topology&, const Articulation&);

  /// What J x must become.
  void ask_for_acceleration(const std::vector<Twist>& V_WB);  // g = -Jdot V
  void ask_for_closing();                                     // J x = -C(q)
  double ask_for_rest(const std::vector<Twist>& V_WB);        // J (V + x) = 0; returns the largest miss there is

  /// Adds to x (per body), the answer of the trees alone, what the forces of the loops make of it. Those forces are added to
  /// `force`, if it is not null.
  void solve(const Topology&, const Articulation&, std::vector<Vec6>& x, std::vector<Vec3>* force);

  /// Sums up the forces found last on the children, over `weight` [s]; per joint, for what can break.
  void sum_up(double weight);
  void forget() { impulse_.assign(impulse_.size(), Vec3::Zero()); }
  const Vec3& impulse(int joint) const { return impulse_[joint]; }  // [N s] since `forget`

 private:
  const Model& model_;
  std::vector<int> joints_;         // that hold
  std::vector<JointRows> rows_;     // of each
  std::vector<int> first_row_;      // of each, in the dense block
  std::vector<char> held_tree_;     // per tree
  std::vector<int> trees_;          // of those, ascending
  std::vector<Constraint> blocks_;  // up to three rows each, as the response wants them
  std::vector<int> members_, offset_;
  int size_ = 0;
  std::size_t stride_ = 0;
  Response response_;
  AlignedVector G_;  // column-major stride_ x size_
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd damped_;
  Eigen::VectorXd wanted_, multiplier_, residual_, step_, softness_;
  std::vector<Vec6> force_, answer_;  // per body
  std::vector<Vec3> impulse_;         // per joint
};

}  // namespace engine
