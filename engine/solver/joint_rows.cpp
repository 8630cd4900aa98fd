#include "engine/solver/joint_rows.h"

namespace engine {
namespace {

struct AxisPair {
  int parent_axis;  // column of R_WFp
  int child_axis;   // column of R_WFc
};
constexpr AxisPair kRevolute[] = {{0, 1}, {2, 1}};
constexpr AxisPair kUniversal[] = {{1, 0}};
constexpr AxisPair kFixed[] = {{0, 1}, {1, 2}, {2, 0}};

const AxisPair* axis_pairs(JointKind kind) {
  switch (kind) {
    case JointKind::revolute:
      return kRevolute;
    case JointKind::universal:
      return kUniversal;
    case JointKind::fixed:
      return kFixed;
    default:
      return nullptr;
  }
}

}  // namespace

int row_count(JointKind kind) {
  switch (kind) {
    case JointKind::revolute:
      return 5;
    case JointKind::universal:
      return 4;
    case JointKind::fixed:
      return 6;
    default:
      return 3;
  }
}

void joint_rows(const Joint& joint, const Pose& X_WP, const Pose& X_WC, JointRows& out) {
  out.r_P = X_WP.q * joint.X_PF.p;
  out.r_C = X_WC.q * joint.X_CF.p;
  out.count = row_count(joint.kind);
  out.error.head<3>() = X_WP.p + out.r_P - X_WC.p - out.r_C;
  if (out.count == 3) return;

  const AxisPair* pairs = axis_pairs(joint.kind);
  const Mat3 R_WFp = (X_WP.q * joint.X_PF.q).toRotationMatrix();
  const Mat3 R_WFc = (X_WC.q * joint.X_CF.q).toRotationMatrix();
  for (int k = 0; k < out.count - 3; ++k) {
    out.t[k] = R_WFp.col(pairs[k].parent_axis);
    out.u[k] = R_WFc.col(pairs[k].child_axis);
    out.n[k] = out.t[k].cross(out.u[k]);
    out.error[3 + k] = out.t[k].dot(out.u[k]);
  }
}

void joint_bias(const Vec3& w_P, const Vec3& w_C, JointRows& out) {
  out.bias.head<3>() = w_C.cross(w_C.cross(out.r_C)) - w_P.cross(w_P.cross(out.r_P));
  for (int k = 0; k < out.count - 3; ++k)
    out.bias[3 + k] = -(w_P.cross(out.t[k]).cross(out.u[k]) + out.t[k].cross(w_C.cross(out.u[k]))).dot(w_P - w_C);
}

namespace {

/// What a row asks of the velocity of the joint's point and of the angular velocity, on (v, w) of a body with the lever r.
Vec6 on_body(const JointRows& rows, int k, const Vec3& r) {
  Vec6 row;
  if (k < 3) {
    row << Vec3::Unit(k), r.cross(Vec3::Unit(k));
  } else {
    row << Vec3::Zero(), rows.n[k - 3];
  }
  return row;
}

}  // namespace

Vec6 row_on_parent(const JointRows& rows, int k) {
  return on_body(rows, k, rows.r_P);
}

Vec6 row_on_child(const JointRows& rows, int k) {
  return -on_body(rows, k, rows.r_C);
}

}  // namespace engine
