#include "engine/solver/loop_closure.h"

#include <algorithm>
#include <cmath>

#include "engine/solver/free_response.h"

namespace engine {
namespace {

constexpr double kProximal = 1e-9;  // [-] of the response of bodies free of joints
constexpr int kIterations = 4;      // of the proximal term

}  // namespace

LoopClosure::LoopClosure(const Model& model)
    : model_(model),
      force_(model.bodies.size(), Vec6::Zero()),
      answer_(model.bodies.size(), Vec6::Zero()),
      impulse_(model.joints.size(), Vec3::Zero()) {}

void LoopClosure::reset(const Topology& topology) {
  const std::size_t loops = topology.loops.size();
  held_tree_.assign(topology.trees.size(), 0);
  trees_.reserve(topology.trees.size());
  joints_.reserve(loops);
  rows_.reserve(loops);
  first_row_.reserve(loops);
  blocks_.reserve(2 * loops);
  members_.reserve(2 * loops);
  offset_.reserve(2 * loops);
  int rows = 0;
  for (const int j : topology.loops) rows += row_count(model_.joints[j].kind);
  for (auto* vector : {&wanted_, &multiplier_, &residual_, &step_, &softness_}) vector->setZero(rows);
  damped_.setIdentity(rows, rows);
  factor_.compute(damped_);  // room for all rows; one only made to a size has a state that is no number
  const auto all = static_cast<std::size_t>(rows);
  G_.reserve(whole_rows(all) * all);
  if (loops > 0) response_.reset(topology, 2 * loops);
}

void LoopClosure::choose(const Topology& topology, const std::vector<char>& broken, const std::vector<char>& awake) {
  std::fill(held_tree_.begin(), held_tree_.end(), 0);
  joints_.clear();
  first_row_.clear();
  blocks_.clear();
  offset_.clear();
  members_.clear();
  trees_.clear();
  size_ = 0;
  for (const int j : topology.loops) {
    const Joint& joint = model_.joints[j];
    const auto moves = [&](int b) { return b >= 0 && !model_.bodies[b].fixed; };
    const auto sleeps = [&](int b) { return moves(b) && !awake[b]; };
    if (broken[j] || sleeps(joint.parent) || sleeps(joint.child)) continue;
    joints_.push_back(j);
    first_row_.push_back(size_);
    for (int k = 0; k < row_count(joint.kind); k += 3) {
      Constraint block;
      block.kind = ConstraintKind::bilateral;
      block.rows = std::min(3, row_count(joint.kind) - k);
      block.a.body = moves(joint.child) ? joint.child : -1;
      block.b.body = moves(joint.parent) ? joint.parent : -1;
      members_.push_back(static_cast<int>(blocks_.size()));
      offset_.push_back(size_ + k);
      blocks_.push_back(block);
    }
    size_ += row_count(joint.kind);
    for (const int b : {joint.parent, joint.child})
      if (moves(b)) held_tree_[topology.tree_of_body[b]] = 1;
  }
  for (int t = 0; t < static_cast<int>(held_tree_.size()); ++t)
    if (held_tree_[t]) trees_.push_back(t);
  rows_.resize(joints_.size());
  stride_ = whole_rows(static_cast<std::size_t>(size_));
  G_.assign(stride_ * static_cast<std::size_t>(size_), 0.0);
  // rows of joints that do not hold stay at the end, as those of the identity: no step allocates when a joint breaks
  for (auto* vector : {&wanted_, &softness_}) vector->setZero();
  damped_.setIdentity();
}

double LoopClosure::place(const std::vector<Pose>& X_WB, double& largest_gap) {
  static const Pose kWorld;
  double largest = 0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = model_.joints[joints_[i]];
    JointRows& rows = rows_[i];
    joint_rows(joint, joint.parent < 0 ? kWorld : X_WB[joint.parent], X_WB[joint.child], rows);
    largest = std::max(largest, rows.error.head(rows.count).cwiseAbs().maxCoeff());
    largest_gap = std::max(largest_gap, gap_of(rows));
    for (int k = 0; k < rows.count; k += 3, ++at) {
      Constraint& block = blocks_[at];
      for (int r = 0; r < block.rows; ++r) {
        if (block.a.body >= 0) block.a.J.row(r) = row_on_child(rows, k + r).transpose();
        if (block.b.body >= 0) block.b.J.row(r) = row_on_parent(rows, k + r).transpose();
        softness_[first_row_[i] + k + r] = kProximal * free_response(model_, X_WB, block, r);
      }
    }
  }
  return largest;
}

void LoopClosure::factor(const Topology& topology, const Articulation& articulation) {
  response_.compute(topology, articulation, blocks_, members_, offset_, stride_, G_);
  for (int c = 0; c < size_; ++c)
    for (int r = 0; r < size_; ++r) damped_(r, c) = G_[static_cast<std::size_t>(c) * stride_ + static_cast<std::size_t>(r)];
  damped_.diagonal() += softness_;
  factor_.compute(damped_);
  damped_.diagonal() -= softness_;
}

void LoopClosure::ask_for_acceleration(const std::vector<Twist>& V_WB) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = model_.joints[joints_[i]];
    joint_bias(joint.parent < 0 ? kStill : V_WB[joint.parent], V_WB[joint.child], rows_[i]);
    wanted_.segment(first_row_[i], rows_[i].count) = rows_[i].bias.head(rows_[i].count);
  }
}

void LoopClosure::ask_for_closing() {
  for (std::size_t i = 0; i < joints_.size(); ++i)
    wanted_.segment(first_row_[i], rows_[i].count) = -rows_[i].error.head(rows_[i].count);
}

double LoopClosure::ask_for_rest(const std::vector<Twist>& V_WB) {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Constraint& c = blocks_[b];
    Vec3 u = Vec3::Zero();
    if (c.a.body >= 0) u += c.a.J.leftCols<3>() * V_WB[c.a.body].v + c.a.J.rightCols<3>() * V_WB[c.a.body].w;
    if (c.b.body >= 0) u += c.b.J.leftCols<3>() * V_WB[c.b.body].v + c.b.J.rightCols<3>() * V_WB[c.b.body].w;
    wanted_.segment(offset_[b], c.rows) = -u.head(c.rows);
  }
  return wanted_.cwiseAbs().maxCoeff();
}

void LoopClosure::solve(const Topology& topology, const Articulation& articulation, std::vector<Vec6>& x,
                        std::vector<Vec3>* force) {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Constraint& c = blocks_[b];
    Vec3 u = Vec3::Zero();
    if (c.a.body >= 0) u += c.a.J * x[c.a.body];
    if (c.b.body >= 0) u += c.b.J * x[c.b.body];
    wanted_.segment(offset_[b], c.rows) -= u.head(c.rows);
  }
  multiplier_.setZero();
  residual_ = wanted_;
  for (int k = 0; k < kIterations; ++k) {
    step_ = factor_.solve(residual_);
    multiplier_ += step_;
    residual_ = wanted_;
    residual_.noalias() -= damped_ * multiplier_;
  }
  for (const int tree : trees_)
    for (int l = topology.trees[tree].begin; l < topology.trees[tree].end; ++l) force_[topology.links[l].body].setZero();
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Constraint& c = blocks_[b];
    Vec3 l = Vec3::Zero();
    l.head(c.rows) = multiplier_.segment(offset_[b], c.rows);
    if (c.a.body >= 0) force_[c.a.body] += c.a.J.transpose() * l;
    if (c.b.body >= 0) force_[c.b.body] += c.b.J.transpose() * l;
  }
  for (const int tree : trees_) {
    const Topology::Tree& range = topology.trees[tree];
    if (force)
      for (int l = range.begin; l < range.end; ++l) (*force)[topology.links[l].body] += force_[topology.links[l].body].head<3>();
    articulation.solve(topology, tree, force_, answer_, Articulation::Bias::zero);
    for (int l = range.begin; l < range.end; ++l) x[topology.links[l].body] += answer_[topology.links[l].body];
  }
}

void LoopClosure::sum_up(double weight) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Vec6 amounts = Vec6::Zero();
    amounts.head(rows_[i].held_along) = multiplier_.segment(first_row_[i], rows_[i].held_along);
    impulse_[joints_[i]] -= weight * along_held(rows_[i], amounts);  // a row pulls the child to the parent's point
  }
}

}  // namespace engine
