// 4x4 matrices as GL wants them (column-major float), made in double.
#pragma once

#include "engine/math/types.h"
#include "render/draw_list.h"

namespace render {

using Mat4 = Eigen::Matrix4d;

inline Matrix4 to_gl(const Mat4& m) {
  Matrix4 out;
  for (int i = 0; i < 16; ++i) out[static_cast<std::size_t>(i)] = static_cast<float>(m.data()[i]);
  return out;
}

inline Mat4 from_gl(const Matrix4& m) {
  Mat4 out;
  for (int i = 0; i < 16; ++i) out.data()[i] = m[static_cast<std::size_t>(i)];
  return out;
}

inline Float3 to_float(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

inline Mat4 rigid(const Pose& X) {
  Mat4 m = Mat4::Identity();
  m.topLeftCorner<3, 3>() = X.q.toRotationMatrix();
  m.topRightCorner<3, 1>() = X.p;
  return m;
}

/// Camera at `eye` looking at `target`: x right, y up, z towards the viewer.
inline Mat4 look_at(const Vec3& eye, const Vec3& target, const Vec3& up) {
  const Vec3 back = (eye - target).normalized();
  const Vec3 right = up.cross(back).normalized();
  Mat4 m = Mat4::Identity();
  m.block<1, 3>(0, 0) = right.transpose();
  m.block<1, 3>(1, 0) = back.cross(right).transpose();
  m.block<1, 3>(2, 0) = back.transpose();
  m.topRightCorner<3, 1>() = -m.topLeftCorner<3, 3>() * eye;
  return m;
}

inline Mat4 perspective(double vertical_fov, double aspect, double near, double far) {
  const double f = 1 / std::tan(vertical_fov / 2);
  Mat4 m = Mat4::Zero();
  m(0, 0) = f / aspect;
  m(1, 1) = f;
  m(2, 2) = (far + near) / (near - far);
  m(2, 3) = 2 * far * near / (near - far);
  m(3, 2) = -1;
  return m;
}

inline Mat4 orthographic(double half_width, double half_height, double near, double far) {
  Mat4 m = Mat4::Identity();
  m(0, 0) = 1 / half_width;
  m(1, 1) = 1 / half_height;
  m(2, 2) = -2 / (far - near);
  m(2, 3) = -(far + near) / (far - near);
  return m;
}

}  // namespace render
