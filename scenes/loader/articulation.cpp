// From anatomical angles to the engine's joints.
//
// The child's attitude in the parent is A = R(flexion) R(abduction) R(turn), each about its axis of the standing person. The engine
// measures its angles from the joint frame: the parent carries F_p = M, the attitude A in the middle of the range, the child F_c =
// 1, so R_FpFc = M^T A, which is 1 in the middle. Its swing (x, y) and twist (z) then stay far from 180 deg: with the shoulder's
// ranges of 240 and 210 deg the corner of the limits lies at 162 deg. A flexed and abducted arm also twists, seen from the middle,
// so the limits are not the anatomical half ranges; they are the smallest box that holds the motion through each angle's whole
// range with the other angles at zero (or their nearest value), and the pose at the start. A universal joint needs none of this.
#include <algorithm>

#include "engine/math/functions.h"
#include "scenes/loader/figure.h"

namespace scenes {
namespace {

using engine::Quat;
using engine::Vec3;

/// Swing x, swing y, twist z of R = swing * twist.
Vec3 swing_twist(Quat r) {
  if (r.w() < 0) r.coeffs() *= -1;
  const double twist = 2 * engine::math::atan2(r.z(), r.w());
  Quat swing = r * engine::math::rotation(-twist, Vec3::UnitZ());
  if (swing.w() < 0) swing.coeffs() *= -1;
  const double s = swing.vec().norm();
  const double scale = s < 1e-12 ? 2 : 2 * engine::math::atan2(s, swing.w()) / s;
  return {scale * swing.x(), scale * swing.y(), twist};
}

std::vector<double> middle(const FigureJoint& joint) {
  std::vector<double> out;
  for (const AnatomicalAngle& angle : joint.angles) out.push_back((angle.lower + angle.upper) / 2);
  return out;
}

/// The box of engine angles over every motion in one plane.
void widen_over_ranges(const FigureJoint& joint, const Quat& q_mid, Vec3& lower, Vec3& upper) {
  constexpr int kSamples = 60;  // the box is found to 0.1 deg
  std::vector<double> angles;
  for (const AnatomicalAngle& angle : joint.angles) angles.push_back(std::clamp(0.0, angle.lower, angle.upper));
  for (std::size_t k = 0; k < angles.size(); ++k) {
    std::vector<double> moved = angles;
    for (int i = 0; i <= kSamples; ++i) {
      moved[k] = joint.angles[k].lower + (joint.angles[k].upper - joint.angles[k].lower) * i / kSamples;
      const Vec3 at = swing_twist(q_mid.conjugate() * articulation(joint, moved));
      lower = lower.cwiseMin(at);
      upper = upper.cwiseMax(at);
    }
  }
}

}  // namespace

Quat articulation(const FigureJoint& joint, const std::vector<double>& angles) {
  Quat out = Quat::Identity();
  for (std::size_t i = 0; i < joint.angles.size(); ++i) out = out * engine::math::rotation(angles[i], joint.angles[i].axis);
  return out;
}

namespace {

/// Cardan cross of flexion (about y) and side (about x): each engine angle is the anatomical one from the middle of its range, up
/// to its sense of turn, so the limits are the ranges themselves.
void make_universal(const FigureJoint& joint, engine::Joint& out) {
  out.kind = engine::JointKind::universal;
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const AnatomicalAngle& angle = joint.angles[k];
    const int axis = k == 0 ? 1 : 0;
    const double sense = angle.axis[axis];
    const double middle = sense * (angle.lower + angle.upper) / 2;
    const double half = (angle.upper - angle.lower) / 2;
    out.angles[static_cast<std::size_t>(axis)] = {
        -half, half, joint.stiffness, -middle, joint.damping, joint.friction_torque, joint.stop_stiffness};
    engine::Quat& q = k == 0 ? out.X_PF.q : out.X_CF.q;
    q = engine::math::rotation(k == 0 ? middle : -middle, Vec3::Unit(axis));
  }
}

}  // namespace

engine::Joint engine_joint(const Figure& figure, const FigureJoint& joint, const std::vector<double>& start_angles) {
  engine::Joint out;
  out.name = joint.name;
  out.kind = joint.angles.size() == 1 ? engine::JointKind::revolute : engine::JointKind::ragdoll;
  out.passive = joint.passive;
  out.passive_share = joint.passive_share;
  out.flexes_about = joint.angles[0].axis.y() < 0 ? -1 : 1;
  const Quat q_mid = articulation(joint, middle(joint));
  out.X_PF = {joint.at - figure.segments[static_cast<std::size_t>(joint.parent)].centre, q_mid};
  out.X_CF = {joint.at - figure.segments[static_cast<std::size_t>(joint.child)].centre, Quat::Identity()};

  if (joint.angles.size() == 2) {
    make_universal(joint, out);
    return out;
  }
  if (joint.slide) out.kind = engine::JointKind::spinal, out.slide = *joint.slide;
  const Vec3 start = swing_twist(q_mid.conjugate() * articulation(joint, start_angles));
  const Vec3 standing = swing_twist(q_mid.conjugate());
  Vec3 lower = start;
  Vec3 upper = start;
  widen_over_ranges(joint, q_mid, lower, upper);
  for (int i = 0; i < 3; ++i) {
    engine::JointCoordinate& angle = out.angles[static_cast<std::size_t>(i)];
    angle = {lower[i], upper[i], joint.stiffness, standing[i], joint.damping, joint.friction_torque, joint.stop_stiffness};
  }
  return out;
}

}  // namespace scenes
