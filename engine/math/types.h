// The few algebra types the whole house speaks.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace engine {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Quat = Eigen::Quaterniond;

/// Place and attitude of a frame B in a frame W: p_W = p + q * p_B. q is a unit quaternion.
struct Pose {
  Vec3 p = Vec3::Zero();      // [m] origin of B in W
  Quat q = Quat::Identity();  // rotates B to W
  Vec3 operator*(const Vec3& p_B) const { return p + q * p_B; }
  Pose operator*(const Pose& X_BC) const { return {p + q * X_BC.p, q * X_BC.q}; }
  Pose inverse() const { return {-(q.conjugate() * p), q.conjugate()}; }
};

/// Velocity of a body: v of its centre of mass [m/s], w angular [rad/s], both in world axes.
struct Twist {
  Vec3 v = Vec3::Zero();
  Vec3 w = Vec3::Zero();
};

/// Matrix of the cross product: skew(a) * b = a x b.
inline Mat3 skew(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

}  // namespace engine
