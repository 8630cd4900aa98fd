#include "engine/step/smooth_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "engine/effects/effect.h"

namespace engine {
namespace {

/// 1/2 (0, w) q as coefficients (x, y, z, w) of Eigen's quaternion.
[[gnu::always_inline]] inline Eigen::Vector4d quaternion_rate(const Eigen::Vector4d& q, const Vec3& w) {
  Eigen::Vector4d rate;
  rate.head<3>() = 0.5 * (q[3] * w + w.cross(q.head<3>()));
  rate[3] = -0.5 * w.dot(q.head<3>());
  return rate;
}

}  // namespace

void displace(Pose& X, const Vec3& dp, const Vec3& rotation) {
  X.p += dp;
  X.q.coeffs() += quaternion_rate(X.q.coeffs(), rotation);
  X.q.normalize();
}

namespace {

/// Angular acceleration by a unit force on a lever [m] from the centre, about an axis at right angles to it: r/I [1/(kg m)].
double swing_per_force(const Body& body, const Vec3& lever_B) {
  const double r = lever_B.norm();
  if (r == 0 || body.fixed) return 0;
  const Mat3 inverse = body.inertia_B.inverse();
  return r * (inverse.trace() - lever_B.dot(inverse * lever_B) / (r * r));
}

}  // namespace

SmoothMotion::SmoothMotion(const Model& model)
    : X_(model.bodies.size()), force_(model.bodies.size()), applied_(model.bodies.size()), joint_force_(model.bodies.size()) {
  for (Stage& stage : stages_) {
    stage.a.resize(model.bodies.size());
    stage.dq.resize(model.bodies.size());
    stage.V.resize(model.bodies.size());
  }
  for (const Joint& joint : model.joints) {
    const double child = swing_per_force(model.bodies[joint.child], joint.X_CF.p);
    const double parent = joint.parent < 0 ? 0 : swing_per_force(model.bodies[joint.parent], joint.X_PF.p);
    swinging_.push_back(child >= parent ? Swinging{joint.child, child} : Swinging{joint.parent, parent});
  }
}

void SmoothMotion::accelerations(World& world, const Trees& trees, Stage& stage, CompliantContacts* compliant, double weight,
                                 FirstStage first) {
  const Model& model = world.model;
  const bool starts = &stage == &stages_[0];
  for_bodies_of(world, trees.list, [&](int b) {
    const Vec3& w = stage.V[b].w;
    const Vec3 w_B = X_[b].q.conjugate() * w;
    force_[b] << 0, 0, 0, -w.cross(X_[b].q * (model.bodies[b].inertia_B * w_B));
  });
  call(world, Hook::add_forces, &Effect::add_forces, world, trees.list, X_, stage.V, force_);
  if (compliant) compliant->add_forces(X_, stage.V, weight, force_);
  if (starts) for_bodies_of(world, trees.list, [&](int b) { applied_[b] = force_[b].head<3>(); });
  const bool begins = first == FirstStage::where_it_begins;
  Articulation& articulation = begins ? world.impulse : world.smooth;
  for (const int tree : trees.list) {
    if (begins)
      articulation.factor_unless_known(world.topology, tree, X_);
    else
      articulation.factor(world.topology, tree, X_, nullptr);
    articulation.set_bias(world.topology, tree, stage.V);
    articulation.solve(world.topology, tree, force_, stage.a, Articulation::Bias::from_rows);
  }
  if (!trees.looped) return;
  double gap = 0;
  world.loops.place(X_, gap);
  world.loops.factor(world.topology, articulation);
  world.loops.ask_for_acceleration(stage.V);
  world.loops.solve(world.topology, articulation, stage.a, starts ? &applied_ : nullptr);
}

void SmoothMotion::take_over(const World& world, const Motion& state) {
  const bool all = std::exchange(copied_, world.still.changes) != world.still.changes;
  const auto take = [&](const auto& from, auto& to) {
    if (all) {
      to = from;
      return;
    }
    for (const int b : world.still.others)
      if (!world.awake[static_cast<std::size_t>(b)]) to[b] = from[b];
  };
  take(state.X_WB, X_);
  for (Stage& stage : stages_) take(state.V_WB, stage.V);
}

Swing SmoothMotion::advance(World& world, std::span<const int> list, bool looped, Motion& motion, double h, Stages stages,
                            CompliantContacts* compliant, FirstStage first) {
  const Trees trees{list, looped};
  if (stages == Stages::two)
    advance_by_two(world, trees, motion, h, first);
  else
    advance_by_four(world, trees, motion, h, compliant, first);
  return swing(world, trees);
}

void SmoothMotion::advance_by_two(World& world, const Trees& trees, Motion& motion, double h, FirstStage first) {
  Stage &start = stages_[0], &end = stages_[1];
  for_bodies_of(world, trees.list, [&](int b) {
    X_[b] = motion.X_WB[b];
    start.V[b] = motion.V_WB[b];
  });
  accelerations(world, trees, start, nullptr, 0.5, first);
  if (trees.looped) world.loops.sum_up(0.5 * h);
  for_bodies_of(world, trees.list, [&](int b) {
    const Twist& at_start = start.V[b];
    const auto a = start.a[b].head<3>(), turning = start.a[b].tail<3>();
    // rotations do not commute (Magnus): without the last term what spins by 0.15 rad a step gains a hundredth of L in 0.2 s
    const Vec3 turn = h * (at_start.w + 0.5 * h * turning + h * h / 12 * turning.cross(at_start.w));
    displace(X_[b], h * (at_start.v + 0.5 * h * a), (1 + turn.squaredNorm() / 12) * turn);  // the tangent of half the angle
    end.V[b].v = at_start.v + h * a;
    end.V[b].w = at_start.w + h * turning;
  });
  accelerations(world, trees, end, nullptr, 0.5, FirstStage::within_step);
  if (trees.looped) world.loops.sum_up(0.5 * h);
  for_bodies_of(world, trees.list, [&](int b) {
    motion.X_WB[b] = X_[b];
    const Vec6 dV = 0.5 * h * (start.a[b] + end.a[b]);
    motion.V_WB[b].v += dV.head<3>();
    motion.V_WB[b].w += dV.tail<3>();
  });
}

void SmoothMotion::advance_by_four(World& world, const Trees& trees, Motion& motion, double h, CompliantContacts* compliant,
                                   FirstStage first) {
  constexpr double kNode[4] = {0, 0.5, 0.5, 1};
  constexpr double kWeight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  std::vector<Pose>& X = motion.X_WB;
  std::vector<Twist>& V = motion.V_WB;
  for (int s = 0; s < 4; ++s) {
    Stage& stage = stages_[s];
    for_bodies_of(world, trees.list, [&](int b) {
      Eigen::Vector4d q = X[b].q.coeffs();
      if (s == 0) {
        X_[b] = X[b];
        stage.V[b] = V[b];
      } else {
        const Stage& before = stages_[s - 1];
        const double c = kNode[s] * h;
        X_[b].p = X[b].p + c * before.V[b].v;
        q += c * before.dq[b];
        X_[b].q.coeffs() = q.normalized();
        stage.V[b].v = V[b].v + c * before.a[b].head<3>();
        stage.V[b].w = V[b].w + c * before.a[b].tail<3>();
      }
      stage.dq[b] = quaternion_rate(q, stage.V[b].w);
    });
    accelerations(world, trees, stage, compliant, kWeight[s], s == 0 ? first : FirstStage::within_step);
    if (trees.looped) world.loops.sum_up(h * kWeight[s]);
  }
  const Stage &k1 = stages_[0], &k2 = stages_[1], &k3 = stages_[2], &k4 = stages_[3];
  double lifted = 0;
  for_bodies_of(world, trees.list, [&](int b) {
    const Vec3 way = h / 6 * (k1.V[b].v + 2 * k2.V[b].v + 2 * k3.V[b].v + k4.V[b].v);
    X[b].p += way;
    X[b].q.coeffs() = (X[b].q.coeffs() + h / 6 * (k1.dq[b] + 2 * k2.dq[b] + 2 * k3.dq[b] + k4.dq[b])).normalized();
    const Vec6 dV = h / 6 * (k1.a[b] + 2 * k2.a[b] + 2 * k3.a[b] + k4.a[b]);
    V[b].v += dV.head<3>();
    V[b].w += dV.tail<3>();
    if (compliant) lifted += world.model.bodies[b].mass * world.model.settings.gravity.dot(0.5 * h * (k1.V[b].v + V[b].v) - way);
  });
  if (compliant) compliant->end_part(k1.V, V, lifted);
}

/// By joint forces from the leaves up: what a body's own acceleration and its children's joints do not explain, its parent's joint
/// gives.
Swing SmoothMotion::swing(const World& world, const Trees& trees) {
  Swing fastest;
  double largest = 0;
  for (const int tree : trees.list) {
    const Topology::Tree& range = world.topology.trees[tree];
    if (range.end - range.begin == 1 && world.topology.links[range.begin].joint < 0) continue;
    for (int l = range.begin; l < range.end; ++l) joint_force_[world.topology.links[l].body].setZero();
    for (int l = range.begin; l < range.end; ++l) {
      const Topology::Link& link = world.topology.links[l];
      if (link.joint < 0) continue;
      const Body& body = world.model.bodies[link.body];
      Vec3& T = joint_force_[link.body];
      T += body.mass * stages_[0].a[link.body].head<3>() - applied_[link.body];
      if (link.parent >= 0) joint_force_[link.parent] += T;
      // the other end of a link is pulled as hard
      const Swinging& swinging = swinging_[static_cast<std::size_t>(link.joint)];
      if (const double square = 2 * T.norm() * swinging.per_force; square > largest) {
        largest = square;
        fastest.body = swinging.body;
      }
    }
  }
  fastest.rate = std::sqrt(largest);
  return fastest;
}

namespace {

/// Rows and error of all joints of a tree at X; returns the largest error.
double joint_errors(World& world, int tree, const std::vector<Pose>& X, double& largest_gap) {
  const Topology::Tree& range = world.topology.trees[tree];
  double largest = 0;
  for (int l = range.begin; l < range.end; ++l) {
    const Topology::Link& link = world.topology.links[l];
    if (link.joint < 0) continue;
    const JointRows& rows = world.smooth.rows_at(world.topology, l, X);
    largest_gap = std::max(largest_gap, gap_of(rows));
    for (int k = 0; k < rows.count; ++k) largest = std::max(largest, std::abs(rows.error[k]));
  }
  return largest;
}

double joint_velocity_errors(World& world, int tree, const std::vector<Twist>& V) {
  const Topology::Tree& range = world.topology.trees[tree];
  double largest = 0;
  for (int l = range.begin; l < range.end; ++l) {
    const Topology::Link& link = world.topology.links[l];
    if (link.joint < 0) continue;
    const Joint& joint = world.model.joints[link.joint];
    JointRows& rows = world.smooth.of_link(l).rows;
    joint_velocity_error(joint.parent < 0 ? kStill : V[joint.parent], V[joint.child], rows);
    largest = std::max(largest, rows.bias.head(rows.count).cwiseAbs().maxCoeff());
  }
  return largest;
}

/// Buffers of a projection, per body.
struct Projected {
  std::vector<Pose>& X;
  std::vector<Twist>& V;
  std::vector<Vec6>& force;
  std::vector<Vec6>& result;
};

/// Trees that are closed at once: one by itself, or all that loops hold.
class Projection {
 public:
  Projection(World& world, std::span<const int> trees, bool loops, bool factored, Projected at)
      : world_(world), trees_(trees), loops_(loops), factored_(factored), at_(at) {}

  double close();  // largest gap [m] left

 private:
  double errors(double& gap) {
    double largest = 0;
    for (const int tree : trees_) largest = std::max(largest, joint_errors(world_, tree, at_.X, gap));
    return loops_ ? std::max(largest, world_.loops.place(at_.X, gap)) : largest;
  }
  double velocity_errors() {
    double largest = 0;
    for (const int tree : trees_) largest = std::max(largest, joint_velocity_errors(world_, tree, at_.V));
    return loops_ ? std::max(largest, world_.loops.ask_for_rest(at_.V)) : largest;
  }
  void factor() {
    for (const int tree : trees_) world_.smooth.factor(world_.topology, tree, at_.X, nullptr);
    if (loops_) world_.loops.factor(world_.topology, world_.smooth);
    factored_ = true;
  }
  template <class Act>
  void for_links(Act act) {
    for (const int tree : trees_)
      for (int l = world_.topology.trees[tree].begin; l < world_.topology.trees[tree].end; ++l)
        act(l, world_.topology.links[l].body);
  }
  /// Answers to the biases of the rows and, if there are any, what is asked of the loops.
  void solve() {
    for_links([&](int, int b) { at_.force[b].setZero(); });
    for (const int tree : trees_) world_.smooth.solve(world_.topology, tree, at_.force, at_.result, Articulation::Bias::from_rows);
    if (loops_) world_.loops.solve(world_.topology, world_.smooth, at_.result, nullptr);
  }

  World& world_;
  std::span<const int> trees_;
  bool loops_;
  bool factored_;  // somewhere near
  Projected at_;
};

double Projection::close() {
  constexpr double kTight = 1e-13;  // [m] and [-]: below it rounding is all there is to remove
  constexpr double kGood = 1e-12;   // [m] and [-] a looser bound would be met by chance in one run and missed in its neighbour
  double gap = 0;
  double error = errors(gap), before = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 6 && error > (k == 0 ? kTight : kGood); ++k) {
    // a factorisation serves as long as it takes out nearly all: that of the last stage does, unless impulses have turned much
    if (!factored_ || error > 1e-2 * before) factor();
    before = error;
    for_links([&](int l, int) {
      JointRows& rows = world_.smooth.of_link(l).rows;
      rows.bias = -rows.error;
    });
    if (loops_) world_.loops.ask_for_closing();
    solve();
    for_links([&](int, int b) { displace(at_.X[b], at_.result[b].head<3>(), at_.result[b].tail<3>()); });
    gap = 0;
    error = errors(gap);
  }
  if (velocity_errors() < kTight) return gap;
  // where the bodies are now, which serves the step that begins there
  factor();
  velocity_errors();
  solve();
  for_links([&](int, int b) {
    at_.V[b].v += at_.result[b].head<3>();
    at_.V[b].w += at_.result[b].tail<3>();
  });
  return gap;
}

}  // namespace

double project_joints(World& world, std::vector<Pose>& X, std::vector<Twist>& V, std::vector<Vec6>& force,
                      std::vector<Vec6>& result, bool factored) {
  const Projected at{X, V, force, result};
  double left = 0;
  for_joined_trees(world, [&](std::span<const int> trees, bool looped) {
    const Topology::Tree& range = world.topology.trees[trees.front()];
    const bool free = range.end - range.begin == 1 && world.topology.links[range.begin].joint < 0;
    if (looped || !free) left = std::max(left, Projection(world, trees, looped, factored, at).close());
  });
  return left;
}

}  // namespace engine
