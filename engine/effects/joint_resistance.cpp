// Resistive spring torque, damping and dry friction of the articulation angles and the passive torques of legs, linearly implicit
// over the step: a light hand on a damped wrist has rates of 1e4 1/s that no explicit scheme holds at 1 ms.
#include <algorithm>
#include <cmath>

#include "engine/effects/passive_legs.h"
#include "engine/effects/registration.h"
#include "engine/effects/words.h"
#include "engine/solver/joint_angles.h"

namespace engine {
namespace {

constexpr double kStuckRate = 1e-5;  // [rad/s] at which a joint held by dry friction gives way: 0.6 mrad in a minute at most
constexpr double kMayGrow = 1.5;     // [-] in a step, of the rate that is looked ahead
constexpr double kHeldBack = 1e-3;   // [rad/s] by more friction than the given: the impulses are found again

bool resists(const ArticulationAngle& a) {
  return a.stiffness > 0 || a.damping > 0 || a.friction_torque > 0;
}
bool resists(const Joint& joint) {
  return joint.passive != PassiveTorque::none ||
         std::any_of(joint.angles.begin(), joint.angles.end(), [](auto& a) { return resists(a); });
}

Finding look_at(const Model& model) {
  std::size_t all = 0, springs = 0, dampers = 0, frictions = 0, passive = 0;
  for (const Joint& joint : model.joints) {
    auto any = [&](auto resists_by) { return std::any_of(joint.angles.begin(), joint.angles.end(), resists_by); };
    all += resists(joint);
    springs += any([](const ArticulationAngle& a) { return a.stiffness > 0; });
    dampers += any([](const ArticulationAngle& a) { return a.damping > 0; });
    frictions += any([](const ArticulationAngle& a) { return a.friction_torque > 0; });
    passive += joint.passive != PassiveTorque::none;
  }
  if (model.joints.empty()) return {false, "no joints", ""};
  if (all == 0) return {false, counted(model.joints.size(), "joint") + ", all of which turn freely", ""};
  std::string how;
  auto add = [&](std::size_t count, const char* what) {
    if (count > 0) how += (how.empty() ? "" : ", ") + std::to_string(count) + " by " + what;
  };
  add(springs, "a spring");
  add(dampers, "damping");
  add(frictions, "friction torque");
  add(passive, "the passive torque of a leg");
  return {true, counted(all, "joint") + " of " + std::to_string(model.joints.size()) + " that resist: " + how, ""};
}

/// Schemes rk4 and adaptive evaluate springs and dampers anew in each stage, unless the damping is too stiff for an explicit scheme
/// at this step (a light hand on a damped wrist): those stay implicit, and so do joints with dry friction, which is not smooth and
/// must hold a spring at the very instant the spring pulls, or the joint creeps.
bool in_stages(const Model& model, const Joint& joint) {
  if (model.settings.scheme == Scheme::stepping) return false;
  if (std::any_of(joint.angles.begin(), joint.angles.end(), [](auto& a) { return a.friction_torque > 0; })) return false;
  constexpr double kStable = 1.5;  // [-] rate times step
  double largest_inverse = 0;
  for (const int b : {joint.parent, joint.child})
    if (b >= 0 && !model.bodies[b].fixed) largest_inverse += 1 / model.bodies[b].inertia_B.diagonal().minCoeff();
  for (const ArticulationAngle& a : joint.angles)
    if (a.damping * largest_inverse * model.settings.step > kStable ||
        a.stiffness * largest_inverse * model.settings.step * model.settings.step > kStable)
      return false;
  return joint.passive == PassiveTorque::none ||
         joint.passive_share * kStiffestPassiveTorque * largest_inverse * model.settings.step * model.settings.step < kStable;
}

/// Torque of springs and dampers [N m] on the child, world axes.
Vec3 smooth_torque(const Joint& joint, const JointAngles& now, const Vec3& w_PC) {
  Vec3 torque = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    const ArticulationAngle& a = joint.angles[i];
    if (!now.free[i]) continue;
    const Vec3 axis = now.axes_W.col(i);
    torque -= a.stiffness * (now.angle[i] - a.rest) * now.gradient_W.col(i) + a.damping * axis.dot(w_PC) * axis;
  }
  return torque;
}

/// The rate [rad/s] at which an angle that turns at `now` will come out of the step if it goes on changing as in the last; held, if
/// it comes to rest on the way.
double expect_slip(Resistance& resistance, const Vec3& change, int angle, double now, double h) {
  const double ahead = std::copysign(1.0, now) * (now + h * change[angle]);
  resistance.rate[angle] = now;
  return resistance.slip_rate[angle] = std::max(std::min(ahead, kMayGrow * std::abs(now)), kStuckRate);
}

Vec3 relative_turning(const Joint& joint, const std::vector<Twist>& V) {
  return V[joint.child].w - (joint.parent < 0 ? Vec3(Vec3::Zero()) : V[joint.parent].w);
}

}  // namespace

/// How the rates of joints with dry friction changed over the last step.
struct FrictionMemory {
  std::vector<Vec3> change;  // [rad/s^2] per joint, per articulation angle

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.change);
  }
};

class JointResistance final : public EffectWith<FrictionMemory> {
 public:
  static constexpr const char* kName = "joint_resistance";
  static Finding look(const Model& model) { return look_at(model); }

  JointResistance(const World& world, int self) : EffectWith(self), legs_(passive_legs(world.model)) {
    for (const Joint& joint : world.model.joints) in_stages_.push_back(resists(joint) && in_stages(world.model, joint));
  }

  void begin(World& world, State& state) override { memory(state).change.assign(world.model.joints.size(), Vec3::Zero()); }

  void before_step(World& world, State& state, double) override {
    if (world.model.settings.scheme != Scheme::stepping) power_ = power_taken(world, state);
  }

  void add_forces(const World& world, const std::vector<Pose>& X, const std::vector<Twist>& V,
                  std::vector<Vec6>& force) const override {
    for (std::size_t j = 0; j < world.model.joints.size(); ++j) {
      const Joint& joint = world.model.joints[j];
      if (!in_stages_[j] || !world.awake[joint.child]) continue;
      const JointAngles now = joint_angles(joint, joint.parent < 0 ? Pose{} : X[joint.parent], X[joint.child]);
      const Vec3 torque = smooth_torque(joint, now, relative_turning(joint, V));
      force[joint.child].tail<3>() += torque;
      if (joint.parent >= 0) force[joint.parent].tail<3>() -= torque;
    }
    for (const PassiveLeg& leg : legs_)
      for_passive_joints(world.model, leg, X, [&](int j, const Vec3& g, double torque, double) {
        const Joint& joint = world.model.joints[j];
        if (!in_stages_[j] || !world.awake[joint.child]) return;
        force[joint.child].tail<3>() += torque * g;
        if (joint.parent >= 0) force[joint.parent].tail<3>() -= torque * g;
      });
  }

  void resist(StepContext& step) override {
    const World& world = step.world;
    const State& state = step.state;
    const double h = step.length;
    for (int j = 0; j < static_cast<int>(world.model.joints.size()); ++j) {
      const Joint& joint = world.model.joints[j];
      JointDamper& damper = step.buffers.dampers[j];
      Resistance& resistance = step.buffers.resistances[j];
      damper.present = false;
      if (!resists(joint)) continue;
      if (!world.awake[joint.child]) {
        memory(step.state).change[j].setZero();
        continue;
      }
      const JointAngles now = joint_angles(joint, joint.parent < 0 ? Pose{} : state.X_WB[joint.parent], state.X_WB[joint.child]);
      const Vec3 w_PC = relative_turning(joint, state.V_WB);
      damper.matrix.setZero();
      resistance.torque_W.setZero();
      resistance.effect = self_;
      resistance.slip_rate.setZero();
      for (int i = 0; i < 3; ++i) {
        const ArticulationAngle& a = joint.angles[i];
        if (!now.free[i] || !resists(a)) continue;
        const Vec3 g = now.gradient_W.col(i), axis = now.axes_W.col(i);
        resistance.axes_W.col(i) = axis;
        const double friction = a.friction_torque / expect_slip(resistance, memory(step.state).change[j], i, axis.dot(w_PC), h);
        const double damping = in_stages_[j] ? 0 : a.damping;
        damper.matrix += h * (damping + friction) * axis * axis.transpose();
        if (in_stages_[j] || a.stiffness == 0) continue;
        damper.matrix += h * h * a.stiffness * g * g.transpose();
        resistance.torque_W -= a.stiffness * (now.angle[i] - a.rest) * g;
      }
      if (damper.matrix.isZero(0)) continue;
      damper.present = true;
      step.any_damper = true;
    }
    for (const PassiveLeg& leg : legs_)
      for_passive_joints(world.model, leg, state.X_WB, [&](int j, const Vec3& g, double torque, double stiffness) {
        if (in_stages_[j] || !world.awake[world.model.joints[j].child]) return;
        step.buffers.dampers[j].matrix += h * h * stiffness * g * g.transpose();
        step.buffers.dampers[j].present = true;
        step.any_damper = true;
        step.buffers.resistances[j].torque_W += torque * g;
      });
  }

  /// Dry friction acts as a damper that yields the given torque at the rate expected at the end of the step. Where a joint was torn
  /// loose the expected rate was far too small and the joint all but rigid: expects the rate at which it would have come out with
  /// the torque given, by its own inertia, and asks for the impulses again.
  bool gave_way(StepContext& step) override {
    const World& world = step.world;
    const double h = step.length;
    bool any = false;
    for (int j = 0; j < static_cast<int>(world.model.joints.size()); ++j) {
      const Joint& joint = world.model.joints[j];
      JointDamper& damper = step.buffers.dampers[j];
      Resistance& resistance = step.buffers.resistances[j];
      if (!damper.present) continue;
      const Vec3 w_PC = relative_turning(joint, step.end.V_WB);
      for (int i = 0; i < 3; ++i) {
        const double torque = joint.angles[i].friction_torque;
        double& assumed = resistance.slip_rate[i];
        if (torque <= 0 || assumed <= 0) continue;
        const Vec3 axis = resistance.axes_W.col(i);
        const double came_out = std::abs(axis.dot(w_PC));
        if (came_out <= assumed) continue;
        double inverse_inertia = 0;
        for (const int b : {joint.parent, joint.child}) {
          if (b < 0 || world.model.bodies[b].fixed) continue;
          const Vec3 axis_B = step.end.X_WB[b].q.conjugate() * axis;
          inverse_inertia += axis_B.dot(axis_B.cwiseQuotient(world.model.bodies[b].inertia_B.diagonal()));
        }
        const double slower = inverse_inertia * torque * h;  // [rad/s] what the torque takes away
        const double held_back = slower * (came_out / assumed - 1);
        if (held_back < kHeldBack) continue;
        const double rate = came_out + held_back;
        damper.matrix += h * torque * (1 / rate - 1 / assumed) * axis * axis.transpose();
        assumed = rate;
        any = true;
      }
    }
    return any;
  }

  void after_step(StepContext& step) override {
    const World& world = step.world;
    State& state = step.state;
    for (std::size_t j = 0; j < world.model.joints.size(); ++j) {
      const Resistance& resistance = step.buffers.resistances[j];
      if (!step.buffers.dampers[j].present || resistance.slip_rate.isZero(0)) continue;
      const Vec3 w_PC = relative_turning(world.model.joints[j], state.V_WB);
      memory(state).change[j] = (resistance.axes_W.transpose() * w_PC - resistance.rate) / step.length;
    }
    if (world.model.settings.scheme == Scheme::stepping) return;
    state.energy.dissipated[self_] += 0.5 * step.length * (power_ + power_taken(world, state));
  }

 private:
  /// Power [W] that springs and dampers evaluated in the stages take out now.
  double power_taken(const World& world, const Motion& at) const {
    double power = 0;
    for (std::size_t j = 0; j < world.model.joints.size(); ++j) {
      const Joint& joint = world.model.joints[j];
      if (!in_stages_[j] || !world.awake[joint.child]) continue;
      const JointAngles now = joint_angles(joint, joint.parent < 0 ? Pose{} : at.X_WB[joint.parent], at.X_WB[joint.child]);
      const Vec3 w_PC = relative_turning(joint, at.V_WB);
      power -= smooth_torque(joint, now, w_PC).dot(w_PC);
    }
    for (const PassiveLeg& leg : legs_)
      for_passive_joints(world.model, leg, at.X_WB, [&](int j, const Vec3& g, double torque, double) {
        const Joint& joint = world.model.joints[j];
        if (!in_stages_[j] || !world.awake[joint.child]) return;
        power -= torque * g.dot(relative_turning(joint, at.V_WB));
      });
    return power;
  }

  std::vector<char> in_stages_;  // per joint: springs and dampers act in the stages of Runge and Kutta
  const std::vector<PassiveLeg> legs_;
  double power_ = 0;  // [W] what those take out at the start of the step
};
template struct Registered<JointResistance>;

}  // namespace engine
