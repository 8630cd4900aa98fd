#include "engine/solver/joint_angles.h"

#include <Eigen/LU>

#include "engine/math/functions.h"

namespace engine {
namespace {

constexpr double kSmallAngle = 1e-4;  // [rad] below it the series of sin(x)/x and the like hold to 1e-17

/// Left Jacobian of the rotation vector: w = J phi'.
Mat3 left_jacobian(const Vec3& phi) {
  const double t = phi.norm();
  const Mat3 P = skew(phi);
  if (t < kSmallAngle) return Mat3::Identity() + 0.5 * P + P * P / 6;
  return Mat3::Identity() + (1 - math::cos(t)) / (t * t) * P + (t - math::sin(t)) / (t * t * t) * P * P;
}

JointAngles swing_twist(const Quat& q_FpFc, const Mat3& R_WFp) {
  JointAngles out;
  Quat q = q_FpFc;
  if (q.w() < 0) q.coeffs() *= -1;
  const double twist_norm = math::hypot(q.w(), q.z());
  const Quat twist = twist_norm > 1e-12 ? Quat(q.w() / twist_norm, 0, 0, q.z() / twist_norm) : Quat::Identity();
  const Quat swing = q * twist.conjugate();
  const double sine = math::hypot(swing.x(), swing.y());
  const double angle = 2 * math::atan2(sine, swing.w());
  const double scale = sine < 0.5 * kSmallAngle ? 2.0 : angle / sine;
  const Vec3 phi(scale * swing.x(), scale * swing.y(), 0);
  out.angle << phi.x(), phi.y(), 2 * math::atan2(twist.z(), twist.w());
  Mat3 B = left_jacobian(phi);
  B.col(2) = swing * Vec3::UnitZ();
  out.gradient_W = R_WFp * B.inverse().transpose();
  const Quat half(1 + q.w(), q.x(), q.y(), q.z());
  out.axes_W = R_WFp * half.normalized().toRotationMatrix();
  for (bool& f : out.free) f = true;
  return out;
}

}  // namespace

JointAngles joint_angles(const Joint& joint, const Pose& X_WP, const Pose& X_WC) {
  const Quat q_WFp = X_WP.q * joint.X_PF.q;
  const Quat q_WFc = X_WC.q * joint.X_CF.q;
  const Quat q = q_WFp.conjugate() * q_WFc;
  const Mat3 R_WFp = q_WFp.toRotationMatrix();
  JointAngles out;
  switch (joint.kind) {
    case JointKind::fixed:
      return out;
    case JointKind::revolute: {
      const double sign = q.w() < 0 ? -1 : 1;
      out.angle[1] = 2 * math::atan2(sign * q.y(), sign * q.w());
      out.gradient_W.col(1) = out.axes_W.col(1) = R_WFp.col(1);
      out.free[1] = true;
      return out;
    }
    case JointKind::universal: {
      // R = R_y(alpha) R_x(beta)
      const Mat3 R = q.toRotationMatrix();
      out.angle[1] = math::atan2(-R(2, 0), R(0, 0));
      out.angle[0] = math::atan2(-R(1, 2), R(1, 1));
      out.gradient_W.col(1) = out.axes_W.col(1) = R_WFp.col(1);
      out.gradient_W.col(0) = out.axes_W.col(0) = q_WFc * Vec3::UnitX();
      out.free[0] = out.free[1] = true;
      return out;
    }
    default:
      return swing_twist(q, R_WFp);
  }
}

}  // namespace engine
