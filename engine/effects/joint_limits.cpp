// Ends of the range of motion: one unilateral row per articulation angle near its end, restitution 0. With Default-Auto a stop is
// rigid. With the compliant law it is a damped spring: a rigid one would stop a head within a single step, and its acceleration,
// dv/dt, would be whatever the step makes it.
#include <algorithm>
#include <cmath>

#include "engine/effects/registration.h"
#include "engine/effects/words.h"
#include "engine/solver/joint_angles.h"

namespace engine {
namespace {

constexpr double kNear = 0.12;    // [rad] a limit this close gets a row ...
constexpr double kPerRate = 2.0;  // ... or one that 2 steps at the present rate would reach

bool has_limit(const ArticulationAngle& angle) {
  return std::isfinite(angle.lower) || std::isfinite(angle.upper);
}

Finding look_at(const Model& model) {
  std::size_t angles = 0, joints = 0;
  for (const Joint& joint : model.joints) {
    const auto of_joint = std::count_if(joint.angles.begin(), joint.angles.end(), has_limit);
    angles += static_cast<std::size_t>(of_joint);
    joints += of_joint > 0;
  }
  if (model.joints.empty()) return {false, "no joints", ""};
  if (angles == 0) return {false, counted(model.joints.size(), "joint") + ", none with a range of motion", ""};
  return {true, counted(angles, "articulation angle") + " of " + counted(joints, "joint") + " with an end to the range of motion",
          "ends out of reach of a step; one passed by more than 0.4 deg has the step taken again in halves"};
}

void add_limit(ContactSearch& search, const Joint& joint, int joint_index, int angle, bool upper, double gap,
               const Vec3& gradient_W, int self) {
  const World& world = search.world;
  Constraint c;
  c.kind = ConstraintKind::limit;
  c.rows = 1;
  auto moving = [&](int body) { return body >= 0 && !world.model.bodies[body].fixed ? body : -1; };
  c.body_a = moving(joint.child);
  c.body_b = moving(joint.parent);
  c.record_a = joint.child;
  c.record_b = joint.parent;
  c.J_a.setZero();
  c.J_b.setZero();
  const double sign = upper ? -1 : 1;
  c.J_a.row(0).tail<3>() = sign * gradient_W.transpose();
  c.J_b.row(0).tail<3>() = -sign * gradient_W.transpose();
  c.gap = gap;
  const bool persons = world.model.bodies[joint.child].person >= 0;
  if (yields(world.model.settings.contact_law, persons) && joint.stop_stiffness > 0) {
    c.stiffness = joint.stop_stiffness;
    for (const int b : {c.body_a, c.body_b}) {
      if (b < 0) continue;
      const Vec3 axis_B = search.at.X_WB[b].q.conjugate() * gradient_W;
      c.free_response += axis_B.dot(world.model.bodies[b].inertia_B.inverse() * axis_B);
    }
  }
  c.key = (static_cast<std::uint64_t>(self) << 56) | (static_cast<std::uint64_t>(joint_index) << 8) |
          static_cast<std::uint64_t>(2 * angle + upper);
  c.effect = self;
  search.found.push_back(c);
}

}  // namespace

class JointLimits final : public Effect {
 public:
  static constexpr const char* kName = "joint_limits";
  static Finding look(const Model& model) { return look_at(model); }

  JointLimits(const World&, int self) : Effect(self) {}

  void find_limits(ContactSearch& search) override {
    const World& world = search.world;
    const Motion& at = search.at;
    for (int j = 0; j < static_cast<int>(world.model.joints.size()); ++j) {
      const Joint& joint = world.model.joints[j];
      if (!world.awake[joint.child] && (joint.parent < 0 || !world.awake[joint.parent])) continue;
      if (!has_limit(joint.angles[0]) && !has_limit(joint.angles[1]) && !has_limit(joint.angles[2])) continue;
      const JointAngles now = joint_angles(joint, joint.parent < 0 ? Pose{} : at.X_WB[joint.parent], at.X_WB[joint.child]);
      const Vec3 w_PC = at.V_WB[joint.child].w - (joint.parent < 0 ? Vec3(Vec3::Zero()) : at.V_WB[joint.parent].w);
      for (int i = 0; i < 3; ++i) {
        if (!now.free[i]) continue;
        const ArticulationAngle& range = joint.angles[i];
        const double near = kNear + kPerRate * search.within * std::abs(now.gradient_W.col(i).dot(w_PC));
        const double above = now.angle[i] - range.lower, below = range.upper - now.angle[i];
        if (above < near) add_limit(search, joint, j, i, false, above, now.gradient_W.col(i), self_);
        if (below < near) add_limit(search, joint, j, i, true, below, now.gradient_W.col(i), self_);
      }
    }
  }
};
template struct Registered<JointLimits>;

}  // namespace engine
