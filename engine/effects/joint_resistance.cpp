// Resistive springs, damping and dry friction of the joints' coordinates and the passive torques of legs, linearly implicit over
// the step: a light hand on a damped wrist has rates of 1e4 1/s that no explicit scheme holds at 1 ms. A spring that the step can
// follow keeps its energy.
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/effects/dry_friction.h"
#include "engine/effects/passive_legs.h"
#include "engine/effects/registration.h"
#include "engine/effects/words.h"
#include "engine/joints/coordinates.h"

namespace engine {
namespace {

bool resists(const JointCoordinate& a) {
  return a.stiffness > 0 || a.damping > 0 || a.friction > 0;
}
template <class Says>
bool any_coordinate(const Joint& joint, Says says) {
  return std::any_of(joint.angles.begin(), joint.angles.end(), says) || says(joint.slide);
}
bool resists(const Joint& joint) {
  return joint.passive != PassiveTorque::none || any_coordinate(joint, [](const JointCoordinate& a) { return resists(a); });
}

Finding look_for_joint_resistance(const Model& model) {
  std::size_t all = 0, springs = 0, dampers = 0, frictions = 0, passive = 0;
  for (const Joint& joint : model.joints) {
    all += resists(joint);
    springs += any_coordinate(joint, [](const JointCoordinate& a) { return a.stiffness > 0; });
    dampers += any_coordinate(joint, [](const JointCoordinate& a) { return a.damping > 0; });
    frictions += any_coordinate(joint, [](const JointCoordinate& a) { return a.friction > 0; });
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
  if (any_coordinate(joint, [](const JointCoordinate& a) { return a.friction > 0; })) return false;
  constexpr double kStable = 1.5;  // [-] rate times step
  double largest_inverse = 0, inverse_mass = 0;
  for (const int b : {joint.parent, joint.child}) {
    if (b < 0 || model.bodies[b].fixed) continue;
    largest_inverse += 1 / model.bodies[b].inertia_B.diagonal().minCoeff();
    inverse_mass += 1 / model.bodies[b].mass;
  }
  const double h = model.settings.step;
  const auto stiff = [h](const JointCoordinate& a, double inverse) {
    return a.damping * inverse * h > kStable || a.stiffness * inverse * h * h > kStable;
  };
  if (std::any_of(joint.angles.begin(), joint.angles.end(), [&](auto& a) { return stiff(a, largest_inverse); })) return false;
  if (stiff(joint.slide, inverse_mass)) return false;
  return joint.passive == PassiveTorque::none || joint.passive_share * kStiffestPassiveTorque * largest_inverse * h * h < kStable;
}

Staged staged_resistance(const Model& model) {
  std::size_t once = 0, staged = 0;
  for (const Joint& joint : model.joints)
    if (resists(joint)) ++(in_stages(model, joint) ? staged : once);
  return {staged > 0, once > 0 ? "resistance of " + counted(once, "joint") : ""};
}

/// Of springs and dampers on the child, world axes: torque [N m] as w and, at the child's point, force [N] as v.
Twist smooth_resistance(const Joint& joint, const JointCoordinates& now, const Twist& relative) {
  Twist out;
  for (int i = 0; i < kCoordinates; ++i) {
    const JointCoordinate& a = joint.coordinate(i);
    if (!now.free[i]) continue;
    const Vec3 axis = now.axes_W.col(i);
    (i == kSlide ? out.v : out.w) -=
        a.stiffness * (now.value[i] - a.rest) * now.gradient_W.col(i) + a.damping * axis.dot(part_of(relative, i)) * axis;
  }
  return out;
}

JointCoordinates coordinates_at(const Joint& joint, const std::vector<Pose>& X) {
  return joint_coordinates(joint, joint.parent < 0 ? Pose{} : X[joint.parent], X[joint.child]);
}

Twist relative_motion_at(const Joint& joint, const JointCoordinates& now, const std::vector<Twist>& V) {
  return relative_motion(now, joint.parent < 0 ? Twist{} : V[joint.parent], V[joint.child]);
}

Vec3 relative_turning(const Joint& joint, const std::vector<Twist>& V) {
  return V[joint.child].w - (joint.parent < 0 ? Vec3(Vec3::Zero()) : V[joint.parent].w);
}

}  // namespace

class JointResistance final : public EffectWith<FrictionMemory> {
 public:
  static constexpr const char* kName = "joint_resistance";
  static constexpr bool kPassive = true;
  static Finding look(const Model& model) { return look_for_joint_resistance(model); }
  static Staged staged(const Model& model) { return staged_resistance(model); }
  static double not_before(const Model&, const Reach& reach) { return reach.all_joints_wait ? reach.first_touch : 0; }
  static bool gives(const Model& model) {
    return std::any_of(model.joints.begin(), model.joints.end(), [](const Joint& joint) {
      return joint.passive != PassiveTorque::none ||
             any_coordinate(joint, [](const JointCoordinate& a) { return a.stiffness > 0; });
    });
  }

  JointResistance(const World& world, int self) : EffectWith(self), legs_(passive_legs(world.model)) {
    awake_legs_.reserve(legs_.size());
    for (const Joint& joint : world.model.joints) in_stages_.push_back(resists(joint) && in_stages(world.model, joint));
    any_in_stages_ = std::find(in_stages_.begin(), in_stages_.end(), 1) != in_stages_.end();
  }

  void begin(World& world, State& state) override {
    for (auto* rates : {&memory(state).change, &memory(state).held_back})
      rates->assign(world.model.joints.size(), Eigen::Vector4d::Zero());
  }

  void before_step(World& world, State& state, double) override {
    list_awake(world, state);
    if (world.model.settings.scheme != Scheme::stepping) power_ = power_taken(world, state);
  }

  void add_forces(const World& world, std::span<const int>, const std::vector<Pose>& X, const std::vector<Twist>& V,
                  std::vector<Vec6>& force) const override {
    if (!any_in_stages_) return;  // scheme stepping: the legs' flexions would be looked up for nothing
    for (const int j : world.awake_joints) {
      const Joint& joint = world.model.joints[j];
      if (!in_stages_[j] || !world.awake[joint.child]) continue;
      const JointCoordinates now = coordinates_at(joint, X);
      const Twist resistance = smooth_resistance(joint, now, relative_motion_at(joint, now, V));
      force[joint.child].tail<3>() += resistance.w;
      if (joint.parent >= 0) force[joint.parent].tail<3>() -= resistance.w;
      if (now.free[kSlide]) add_along_slide(now, joint, resistance.v, force);
    }
    for (const PassiveLeg& leg : awake_legs_)
      for_passive_joints(world.model, leg, X, [&](int j, const Vec3& g, double torque, double) {
        const Joint& joint = world.model.joints[j];
        if (!in_stages_[j] || !world.awake[joint.child]) return;
        force[joint.child].tail<3>() += torque * g;
        if (joint.parent >= 0) force[joint.parent].tail<3>() -= torque * g;
      });
  }

  void find(StepContext& step) override { list_awake(step.world, step.state); }

  void resist(StepContext& step) override {
    const World& world = step.world;
    for (const int j : world.awake_joints) {
      step.buffers.dampers[j].present = false;
      if (resists(world.model.joints[j]) && world.awake[world.model.joints[j].child]) resist_in(step, j);
    }
    for (const PassiveLeg& leg : awake_legs_)
      for_passive_joints(world.model, leg, step.state.X_WB, [&](int j, const Vec3& g, double torque, double stiffness) {
        if (in_stages_[j] || !world.awake[world.model.joints[j].child]) return;
        step.buffers.dampers[j].turning += step.length * step.length * stiffness * g * g.transpose();
        step.buffers.dampers[j].present = true;
        step.any_damper = true;
        step.buffers.resistances[j].torque_W += torque * g;
      });
  }

  bool gave_way(StepContext& step) override {
    bool any = false;
    for (const int j : step.world.awake_joints) {
      if (!step.buffers.dampers[j].present || !engine::gave_way(step, j)) continue;
      step.buffers.loosened[step.world.topology.tree_of_body[step.world.model.joints[j].child]] = 1;
      any = true;
    }
    return any;
  }

  void after_step(StepContext& step) override {
    const World& world = step.world;
    State& state = step.state;
    for (const int j : world.awake_joints) {
      const Resistance& resistance = step.buffers.resistances[j];
      if (!step.buffers.dampers[j].present) continue;
      const JointCoordinates& at_start = resistance.at_start;
      const Twist relative = relative_motion_at(world.model.joints[j], at_start, state.V_WB);
      Eigen::Vector4d rate;
      rate << at_start.axes_W.leftCols<3>().transpose() * relative.w, at_start.axes_W.col(kSlide).dot(relative.v);
      memory(state).change[j] = (rate - resistance.rate) / step.length;
      memory(state).held_back[j] = resistance.held_back;
    }
    if (world.model.settings.scheme == Scheme::stepping) return;
    state.energy.dissipated[self_] += 0.5 * step.length * (power_ + power_taken(world, state));
  }

 private:
  /// Who has begun to wait or to move: what waits is not looked at again.
  void list_awake(const World& world, State& state) {
    if (std::exchange(listed_, world.still.changes) == world.still.changes) return;
    const auto waits = [&world](const Joint& joint) { return !world.awake[joint.child]; };
    for (std::size_t j = 0; j < world.model.joints.size(); ++j)
      if (const Joint& joint = world.model.joints[j]; resists(joint) && waits(joint))
        memory(state).change[j].setZero(), memory(state).held_back[j].setZero();
    awake_legs_.clear();
    for (const PassiveLeg& leg : legs_)
      for (const int j : {leg.hip, leg.knees[0], leg.knees[1], leg.ankle})
        if (j >= 0 && !waits(world.model.joints[j])) {
          awake_legs_.push_back(leg);
          break;
        }
  }

  /// A spring taken at the end of the step is stable however stiff, and damps out what it would swing.
  void tell_of_lost_swing(StepContext& step, const Joint& joint, const JointCoordinate& a, double response) {
    const Model& model = step.world.model;
    const bool within_person = joint.parent >= 0 && model.bodies[joint.parent].person >= 0;  // damped by themselves
    if (within_person || a.damping * a.damping * response >= 4 * a.stiffness || told_of_swing_) return;
    told_of_swing_ = true;
    step.world.log.diagnostics.warnings.push_back(
        "joint " + joint.name + ": its spring swings at " + number(std::sqrt(a.stiffness * response)) + " rad/s, which a step of " +
        number(1e3 * step.length) + " ms does not follow: the swing is damped out; take a step below " +
        number(1e3 * std::sqrt(0.5 / (a.stiffness * response))) + " ms, or less stiffness");
  }

  void resist_in(StepContext& step, int j) {
    const Joint& joint = step.world.model.joints[j];
    JointDamper& damper = step.buffers.dampers[j];
    Resistance& resistance = step.buffers.resistances[j];
    const double h = step.length;
    const JointCoordinates& now = resistance.at_start =
        step.world.coordinates.at(joint, static_cast<std::size_t>(j), step.state.X_WB);
    const Twist relative = relative_motion_at(joint, now, step.state.V_WB);
    damper = {};
    resistance.torque_W.setZero();
    resistance.force_W.setZero();
    resistance.effect = self_;
    resistance.slip_rate.setZero();
    resistance.held_back.setZero();
    for (int i = 0; i < kCoordinates; ++i) {
      const JointCoordinate& a = joint.coordinate(i);
      if (!now.free[i] || !resists(a)) continue;
      Mat3& matrix = i == kSlide ? damper.sliding : damper.turning;
      const Vec3 g = now.gradient_W.col(i), axis = now.axes_W.col(i);
      resistance.rate[i] = axis.dot(part_of(relative, i));
      if (a.friction > 0) add_friction(step, memory(step.state), j, i);
      if (in_stages_[j]) continue;
      matrix += h * a.damping * axis * axis.transpose();
      if (a.stiffness == 0) continue;
      // a spring at the mean of its values at both ends neither gains nor loses energy of itself; one too stiff for the step at its
      // end, which is stable however stiff
      const double response = coordinate_response(step, j, i, axis);
      const bool followed = h * h * a.stiffness * response < 0.5;
      if (!followed) tell_of_lost_swing(step, joint, a, response);
      const double rate = followed ? g.dot(part_of(relative, i)) : 0;
      matrix += (followed ? 0.25 : 1) * h * h * a.stiffness * g * g.transpose();
      (i == kSlide ? resistance.force_W : resistance.torque_W) -= a.stiffness * (now.value[i] + 0.25 * h * rate - a.rest) * g;
    }
    damper.present = damper.present || !damper.turning.isZero(0) || !damper.sliding.isZero(0);
    step.any_damper = step.any_damper || damper.present;
  }

  /// Power [W] that springs and dampers evaluated in the stages take out now.
  double power_taken(const World& world, const Motion& at) const {
    double power = 0;
    for (const int j : world.awake_joints) {
      const Joint& joint = world.model.joints[j];
      if (!in_stages_[j] || !world.awake[joint.child]) continue;
      const JointCoordinates now = coordinates_at(joint, at.X_WB);
      const Twist relative = relative_motion_at(joint, now, at.V_WB);
      const Twist resistance = smooth_resistance(joint, now, relative);
      power -= resistance.w.dot(relative.w) + (now.free[kSlide] ? resistance.v.dot(relative.v) : 0);
    }
    for (const PassiveLeg& leg : awake_legs_)
      for_passive_joints(world.model, leg, at.X_WB, [&](int j, const Vec3& g, double torque, double) {
        const Joint& joint = world.model.joints[j];
        if (!in_stages_[j] || !world.awake[joint.child]) return;
        power -= torque * g.dot(relative_turning(joint, at.V_WB));
      });
    return power;
  }

  std::vector<char> in_stages_;  // per joint: springs and dampers act in the stages of Runge and Kutta
  bool any_in_stages_ = false;
  const std::vector<PassiveLeg> legs_;
  std::vector<PassiveLeg> awake_legs_;
  double power_ = 0;  // [W] what those take out at the start of the step
  long listed_ = 0;   // StillBodies::changes when the awake legs were
  bool told_of_swing_ = false;
};
template struct Registered<JointResistance>;

}  // namespace engine
