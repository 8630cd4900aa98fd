#include "engine/joints/coordinates.h"

#include <Eigen/LU>

#include "engine/joints/joint_type.h"
#include "engine/math/functions.h"
#include "engine/math/same_bits.h"

namespace engine {
namespace {

constexpr double kSmallAngle = 1e-4;  // [rad] below it the series of sin(x)/x and the like hold to 1e-17

/// Left Jacobian of the rotation vector of a swing: w = J phi'. Sine and cosine of its angle by those of half of it.
Mat3 left_jacobian(const Vec3& phi, double half_sine, double half_cosine) {
  const double t = phi.norm();
  const Mat3 P = skew(phi);
  if (t < kSmallAngle) return Mat3::Identity() + 0.5 * P + P * P / 6;
  return Mat3::Identity() + 2 * half_sine * half_sine / (t * t) * P + (t - 2 * half_sine * half_cosine) / (t * t * t) * P * P;
}

}  // namespace

void add_turn_about_y(const JointFrames& at, JointCoordinates& out) {
  const Quat q = at.q_WFp.conjugate() * at.q_WFc;
  const double sign = q.w() < 0 ? -1 : 1;
  out.value[1] = 2 * math::atan2(sign * q.y(), sign * q.w());
  out.gradient_W.col(1) = out.axes_W.col(1) = at.q_WFp.toRotationMatrix().col(1);
  out.free[1] = true;
}

void add_swing_and_twist(const JointFrames& at, JointCoordinates& out) {
  Quat q = at.q_WFp.conjugate() * at.q_WFc;
  const Mat3 R_WFp = at.q_WFp.toRotationMatrix();
  if (q.w() < 0) q.coeffs() *= -1;
  const double twist_norm = math::hypot(q.w(), q.z());
  const Quat twist = twist_norm > 1e-12 ? Quat(q.w() / twist_norm, 0, 0, q.z() / twist_norm) : Quat::Identity();
  const Quat swing = q * twist.conjugate();
  const double sine = math::hypot(swing.x(), swing.y());
  const Eigen::Vector2d halves = math::two_atan2({sine, twist.z()}, {swing.w(), twist.w()});
  const double scale = sine < 0.5 * kSmallAngle ? 2.0 : 2 * halves[0] / sine;
  const Vec3 phi(scale * swing.x(), scale * swing.y(), 0);
  out.value.head<3>() << phi.x(), phi.y(), 2 * halves[1];
  Mat3 B = left_jacobian(phi, sine, swing.w());
  B.col(2) = swing * Vec3::UnitZ();
  out.gradient_W.leftCols<3>() = R_WFp * B.inverse().transpose();
  const Quat half(1 + q.w(), q.x(), q.y(), q.z());
  out.axes_W.leftCols<3>() = R_WFp * half.normalized().toRotationMatrix();
  out.free[0] = out.free[1] = out.free[2] = true;
}

void add_slide_along(const Vec3& axis_F, const JointFrames& at, JointCoordinates& out) {
  const Vec3 axis = at.q_WFp * axis_F;
  const Vec3 point = at.X_WC * at.joint.X_CF.p;
  out.value[kSlide] = axis.dot(point - at.X_WP * at.joint.X_PF.p);
  out.gradient_W.col(kSlide) = out.axes_W.col(kSlide) = axis;
  out.r_P = point - at.X_WP.p;
  out.r_C = point - at.X_WC.p;
  out.free[kSlide] = true;
}

JointCoordinates joint_coordinates(const Joint& joint, const Pose& X_WP, const Pose& X_WC) {
  const JointFrames at{joint, X_WP, X_WC, X_WP.q * joint.X_PF.q, X_WC.q * joint.X_CF.q};
  JointCoordinates out;
  type_of(joint.kind).coordinates(at, out);
  return out;
}

const JointCoordinates& KnownCoordinates::at(const Joint& joint, std::size_t j, const std::vector<Pose>& X_WB) {
  static const Pose kWorld;
  Known& known = known_[j];
  const Pose &X_WP = joint.parent < 0 ? kWorld : X_WB[joint.parent], &X_WC = X_WB[joint.child];
  if (!(known.any && same_bits(known.X_WC, X_WC) && same_bits(known.X_WP, X_WP)))
    known = {X_WP, X_WC, joint_coordinates(joint, X_WP, X_WC), true};
  return known.now;
}

Twist relative_motion(const JointCoordinates& now, const Twist& P, const Twist& C) {
  Twist out;
  out.w = C.w - P.w;
  if (now.free[kSlide]) out.v = C.v + C.w.cross(now.r_C) - P.v - P.w.cross(now.r_P);
  return out;
}

void add_along_slide(const JointCoordinates& now, const Joint& joint, const Vec3& F, std::vector<Vec6>& on_bodies) {
  const auto add = [&](int body, double sign, const Vec3& r) {
    if (body < 0) return;
    on_bodies[body].head<3>() += sign * F;
    on_bodies[body].tail<3>() += sign * r.cross(F);
  };
  add(joint.child, 1, now.r_C);
  add(joint.parent, -1, now.r_P);
}

}  // namespace engine
