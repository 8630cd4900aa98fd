// Ends of the range of motion: one unilateral row per articulation angle near its end, restitution 0. With Default-Auto a stop is
// rigid. With the compliant law it is a damped spring: a rigid one would stop a head within a single step, and its acceleration,
// dv/dt, would be whatever the step makes it.
#include <algorithm>
#include <cmath>

#include "engine/effects/registration.h"
#include "engine/effects/words.h"
#include "engine/joints/coordinates.h"

namespace engine {
namespace {

constexpr double kNearLimit = 0.12;  // [rad] a limit this close gets a row ...
constexpr double kNearSlide = 0.01;  // [m] the same of a slide
constexpr double kPerRate = 2.0;     // ... or one that 2 steps at the present rate would reach

bool has_limit(const JointCoordinate& range) {
  return std::isfinite(range.lower) || std::isfinite(range.upper);
}

Finding look_for_joint_limits(const Model& model) {
  std::size_t angles = 0, slides = 0, joints = 0;
  for (const Joint& joint : model.joints) {
    const auto of_joint = static_cast<std::size_t>(std::count_if(joint.angles.begin(), joint.angles.end(), has_limit));
    const bool slide = has_limit(joint.slide);
    angles += of_joint;
    slides += slide;
    joints += of_joint > 0 || slide;
  }
  if (model.joints.empty()) return {false, "no joints", ""};
  if (joints == 0) return {false, counted(model.joints.size(), "joint") + ", none with a range of motion", ""};
  const std::string what = (angles > 0 ? counted(angles, "articulation angle") : "") + (angles > 0 && slides > 0 ? " and " : "") +
                           (slides > 0 ? counted(slides, "slide") : "");
  std::string left_out = "ends out of reach of a step";
  if (model.settings.contact_law != ContactLaw::compliant) {  // whose stops are springs
    const std::string bound = angles == 0 ? "0.9 mm" : slides == 0 ? "0.4 deg" : "0.4 deg or 0.9 mm";
    left_out += "; one passed by more than " + bound + " has the step taken again in halves";
  }
  return {true, what + " of " + counted(joints, "joint") + " with an end to the range of motion", left_out};
}

/// Response [1/kg] or [1/(kg m^2)] of a row if its bodies were free of joints.
double free_response(const Model& model, const Motion& at, const Constraint& c, const Vec3& gradient_W) {
  double response = 0;
  const auto add = [&](int b, const auto& J) {
    if (b < 0) return;
    const Body& body = model.bodies[b];
    const Vec3 axis_B = at.X_WB[b].q.conjugate() * (c.slides ? Vec3(J.row(0).template tail<3>()) : gradient_W);
    response += (c.slides ? 1 / body.mass : 0) + axis_B.dot(body.inertia_B.inverse() * axis_B);
  };
  add(c.a.body, c.a.J);
  add(c.b.body, c.b.J);
  return response;
}

/// One end of the range of coordinate `i`.
struct End {
  int joint, i;
  bool upper;
  double gap;  // [rad] or [m]
};

void add_limit(ContactSearch& search, const JointCoordinates& now, const End& end, int self) {
  const World& world = search.world;
  const Joint& joint = world.model.joints[end.joint];
  const Vec3 gradient_W = now.gradient_W.col(end.i);
  Constraint c;
  c.kind = ConstraintKind::limit;
  c.rows = 1;
  c.slides = end.i == kSlide;
  set_bodies(c, world.model, joint.child, joint.parent);
  const double sign = end.upper ? -1 : 1;
  if (c.slides) {
    c.a.J.row(0) << sign * gradient_W.transpose(), sign * now.r_C.cross(gradient_W).transpose();
    c.b.J.row(0) << -sign * gradient_W.transpose(), -sign * now.r_P.cross(gradient_W).transpose();
  } else {
    c.a.J.row(0).tail<3>() = sign * gradient_W.transpose();
    c.b.J.row(0).tail<3>() = -sign * gradient_W.transpose();
  }
  c.gap = end.gap;
  const bool persons = world.model.bodies[joint.child].person >= 0;
  if (const double stiffness = joint.coordinate(end.i).stop_stiffness;
      yields(world.model.settings.contact_law, persons) && stiffness > 0) {
    c.spring.stiffness = stiffness;
    c.response.free = free_response(world.model, search.at, c, gradient_W);
  }
  c.key = (static_cast<std::uint64_t>(self) << 56) | (static_cast<std::uint64_t>(end.joint) << 8) |
          static_cast<std::uint64_t>(2 * end.i + end.upper);
  c.effect = self;
  search.found.push_back(c);
}

}  // namespace

class JointLimits final : public Effect {
 public:
  static constexpr const char* kName = "joint_limits";
  static constexpr bool kPassive = true;
  static Finding look(const Model& model) { return look_for_joint_limits(model); }
  static double not_before(const Model&, const Reach& reach) { return reach.all_joints_wait ? reach.first_touch : 0; }
  static bool gives(const Model& model) { return model.settings.contact_law != ContactLaw::default_auto; }

  JointLimits(const World&, int self) : Effect(self) {}

  void find_limits(ContactSearch& search) override {
    World& world = search.world;
    const Motion& at = search.at;
    for (const int j : world.awake_joints) {
      const Joint& joint = world.model.joints[j];
      const auto& angles = joint.angles;
      if (!has_limit(angles[0]) && !has_limit(angles[1]) && !has_limit(angles[2]) && !has_limit(joint.slide)) continue;
      const JointCoordinates& now = world.coordinates.at(joint, static_cast<std::size_t>(j), at.X_WB);
      const Twist relative = relative_motion(now, joint.parent < 0 ? Twist{} : at.V_WB[joint.parent], at.V_WB[joint.child]);
      for (int i = 0; i < kCoordinates; ++i) {
        if (!now.free[i]) continue;
        const JointCoordinate& range = joint.coordinate(i);
        const double rate = now.gradient_W.col(i).dot(part_of(relative, i));
        const double near = (i == kSlide ? kNearSlide : kNearLimit) + kPerRate * search.within * std::abs(rate);
        const double above = now.value[i] - range.lower, below = range.upper - now.value[i];
        if (above < near) add_limit(search, now, {j, i, false, above}, self_);
        if (below < near) add_limit(search, now, {j, i, true, below}, self_);
      }
    }
  }
};
template struct Registered<JointLimits>;

}  // namespace engine
