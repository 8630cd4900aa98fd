// Joints that close a ring or can break (a rider's hands on a bar). The smooth motion and the projection of the joints keep them
// (solver/loop_closure.h); where a step exchanges impulses, they are bilateral rows among them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/effects/registration.h"
#include "engine/effects/words.h"
#include "engine/joints/rows.h"
#include "engine/math/functions.h"
#include "engine/solver/free_response.h"

namespace engine {
namespace {

// [s] a hand gives way in some milliseconds: rigid impacts exchange impulses in no time, their force is taken over this
constexpr double kGrasp = 0.01;
// [-] of the response of free bodies, given to each row: what other joints hold already (two hinges on one axis) has no response
// of its own, and rounding divided by rounding would be its impulse
constexpr double kGive = 5e-9;

Finding look_for_joint_loops(const Model& model) {
  const std::vector<int> loops = build_topology(model, {}).loops;
  if (model.joints.empty()) return {false, "no joints", ""};
  if (loops.empty()) return {false, counted(model.joints.size(), "joint") + ": none closes a ring, none can break", ""};
  double least = std::numeric_limits<double>::infinity();
  std::size_t breakable = 0;
  for (const int j : loops) {
    least = std::min(least, model.joints[j].breaking_force);
    breakable += std::isfinite(model.joints[j].breaking_force);
  }
  std::string reason;
  if (breakable > 0)
    reason = counted(breakable, "joint") + " that can break, from " + number(1e-3 * least) + " kN on (mean over 10 ms)";
  if (loops.size() > breakable)
    reason += (reason.empty() ? "" : ", ") + counted(loops.size() - breakable, "joint closes", "joints close") + " a ring";
  return {true, reason, ""};
}

}  // namespace

/// What each breakable joint carries, as a mean that forgets with kGrasp.
struct LoopLoads {
  std::vector<Vec3> load;  // [N] on the child, per joint

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.load);
  }
};

class JointLoops final : public EffectWith<LoopLoads> {
 public:
  static constexpr const char* kName = "joint_loops";
  static Finding look(const Model& model) { return look_for_joint_loops(model); }

  JointLoops(const World&, int self) : EffectWith(self) {}

  void begin(World& world, State& state) override { memory(state).load.assign(world.model.joints.size(), Vec3::Zero()); }

  void find(StepContext& step) override {
    const World& world = step.world;
    const State& state = step.state;
    for (const int j : world.loops.joints()) {
      const Joint& joint = world.model.joints[j];
      JointRows rows;
      joint_rows(joint, joint.parent < 0 ? Pose{} : state.X_WB[joint.parent], state.X_WB[joint.child], rows);
      for (int k = 0; k < rows.count; ++k) {
        Constraint c;
        c.kind = ConstraintKind::bilateral;
        c.rows = 1;
        set_bodies(c, world.model, joint.child, joint.parent);
        c.a.J.row(0) = row_on_child(rows, k).transpose();
        c.b.J.row(0) = row_on_parent(rows, k).transpose();
        c.softness = kGive * free_response(world.model, state.X_WB, c, 0);
        c.key = (static_cast<std::uint64_t>(self_) << 56) | (static_cast<std::uint64_t>(j) << 8) | static_cast<std::uint64_t>(k);
        c.effect = self_;
        step.constraints.push_back(c);
      }
    }
  }

  /// Above its strength a joint lets go for good.
  void after_step(StepContext& step) override {
    const World& world = step.world;
    State& state = step.state;
    const double h = step.length;
    std::vector<Vec3>& load = memory(state).load;
    if (load.empty()) return;
    const double forget = math::exp(-h / kGrasp);
    for (const int j : world.topology.loops) load[j] = forget * load[j] + (1 - forget) / h * world.loops.impulse(j);
    for (const Constraint& c : step.constraints) {
      if (c.effect != self_ || c.kind != ConstraintKind::bilateral) continue;
      const Vec3 direction = c.a.body >= 0 ? Vec3(c.a.J.row(0).head<3>()) : Vec3(-c.b.J.row(0).head<3>());
      load[(c.key >> 8) & 0xffff] += (1 - forget) / h * c.impulse[0] * direction;
    }
    for (const int j : world.topology.loops) {
      const Joint& joint = world.model.joints[j];
      if (state.broken[j] || load[j].norm() <= joint.breaking_force) continue;
      state.broken[j] = 1;
      step.world.log.events.push_back(
          {state.time, "joint_broken", joint.child, joint.parent, state.X_WB[joint.child] * joint.X_CF.p, load[j].norm()});
    }
  }
};
template struct Registered<JointLoops>;

}  // namespace engine
