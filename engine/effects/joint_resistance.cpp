// Resistive spring torque, damping and dry friction of the articulation angles, linearly implicit over the step: a light hand on a
// damped wrist has rates of 1e4 1/s that no explicit scheme holds at 1 ms.
#include <algorithm>
#include <cmath>

#include "engine/effects/effects.h"
#include "engine/solver/joint_angles.h"

namespace engine {
namespace {

constexpr double kFrictionRate = 0.05;  // [rad/s] below it dry friction acts like a damper

bool resists(const ArticulationAngle& a) {
  return a.stiffness > 0 || a.damping > 0 || a.friction_torque > 0;
}
bool resists(const Joint& joint) {
  return std::any_of(joint.angles.begin(), joint.angles.end(), [](auto& a) { return resists(a); });
}

std::optional<std::string> called_for(const Model& model) {
  const auto count = std::count_if(model.joints.begin(), model.joints.end(), [](const Joint& j) { return resists(j); });
  if (count == 0) return std::nullopt;
  return std::to_string(count) + " joints have a spring, damping or friction";
}

void resist(World& world, const State& state, int self) {
  const double h = world.step;
  for (int j = 0; j < static_cast<int>(world.model.joints.size()); ++j) {
    const Joint& joint = world.model.joints[j];
    JointDamper& damper = world.dampers[j];
    damper.present = false;
    if (!resists(joint) || !world.awake[joint.child]) continue;
    const JointAngles now = joint_angles(joint, joint.parent < 0 ? Pose{} : state.X_WB[joint.parent], state.X_WB[joint.child]);
    const Vec3 w_PC = state.V_WB[joint.child].w - (joint.parent < 0 ? Vec3(Vec3::Zero()) : state.V_WB[joint.parent].w);
    damper.matrix.setZero();
    world.resistances[j].torque_W.setZero();
    world.resistances[j].effect = self;
    for (int i = 0; i < 3; ++i) {
      const ArticulationAngle& a = joint.angles[i];
      if (!now.free[i] || !resists(a)) continue;
      const Vec3 g = now.gradient_W.col(i);
      const double rate = g.dot(w_PC);
      const double friction = a.friction_torque / std::max(std::abs(rate), kFrictionRate);
      damper.matrix += (h * (a.damping + friction) + h * h * a.stiffness) * g * g.transpose();
      world.resistances[j].torque_W -= a.stiffness * (now.angle[i] - a.rest) * g;
    }
    damper.present = true;
    world.any_damper = true;
  }
}

}  // namespace

const Effect kJointResistanceEffect{.name = "joint_resistance", .called_for = called_for, .resist = resist};

}  // namespace engine
