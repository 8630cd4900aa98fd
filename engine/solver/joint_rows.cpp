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
  const Vec3 r_P = X_WP.q * joint.X_PF.p;
  const Vec3 r_C = X_WC.q * joint.X_CF.p;
  out.count = row_count(joint.kind);
  out.J_P.topLeftCorner<3, 3>().setIdentity();
  out.J_P.topRightCorner<3, 3>() = -skew(r_P);
  out.J_C.topLeftCorner<3, 3>() = -Mat3::Identity();
  out.J_C.topRightCorner<3, 3>() = skew(r_C);
  out.error.head<3>() = X_WP.p + r_P - X_WC.p - r_C;
  if (out.count == 3) return;

  const AxisPair* pairs = axis_pairs(joint.kind);
  const Mat3 R_WFp = (X_WP.q * joint.X_PF.q).toRotationMatrix();
  const Mat3 R_WFc = (X_WC.q * joint.X_CF.q).toRotationMatrix();
  for (int row = 3; row < out.count; ++row) {
    const Vec3 t = R_WFp.col(pairs[row - 3].parent_axis);
    const Vec3 u = R_WFc.col(pairs[row - 3].child_axis);
    const Vec3 n = t.cross(u);
    out.J_P.row(row) << 0, 0, 0, n.transpose();
    out.J_C.row(row) << 0, 0, 0, -n.transpose();
    out.error[row] = t.dot(u);
  }
}

void joint_bias(const Joint& joint, const Pose& X_WP, const Pose& X_WC, const Vec3& w_P, const Vec3& w_C, JointRows& out) {
  const Vec3 r_P = X_WP.q * joint.X_PF.p;
  const Vec3 r_C = X_WC.q * joint.X_CF.p;
  out.bias.head<3>() = -(w_P.cross(w_P.cross(r_P)) - w_C.cross(w_C.cross(r_C)));
  if (out.count == 3) return;

  const AxisPair* pairs = axis_pairs(joint.kind);
  const Mat3 R_WFp = (X_WP.q * joint.X_PF.q).toRotationMatrix();
  const Mat3 R_WFc = (X_WC.q * joint.X_CF.q).toRotationMatrix();
  for (int row = 3; row < out.count; ++row) {
    const Vec3 t = R_WFp.col(pairs[row - 3].parent_axis);
    const Vec3 u = R_WFc.col(pairs[row - 3].child_axis);
    out.bias[row] = -(w_P.cross(t).cross(u) + t.cross(w_C.cross(u))).dot(w_P - w_C);
  }
}

}  // namespace engine
