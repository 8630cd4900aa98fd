#include "engine/joints/rows.h"

namespace engine {

int row_count(JointKind kind) {
  return type_of(kind).rows();
}

void joint_rows(const Joint& joint, const Pose& X_WP, const Pose& X_WC, JointRows& out) {
  const JointType& type = type_of(joint.kind);
  out.r_P = X_WP.q * joint.X_PF.p;
  out.r_C = X_WC.q * joint.X_CF.p;
  out.count = type.rows();
  out.held_along = type.held_along;
  out.error.head<3>() = X_WP.p + out.r_P - X_WC.p - out.r_C;
  if (out.count == 3 && out.held_along == 3) return;

  const Mat3 R_WFp = (X_WP.q * joint.X_PF.q).toRotationMatrix();
  const Mat3 R_WFc = (X_WC.q * joint.X_CF.q).toRotationMatrix();
  if (out.held_along < 3) {
    const Vec3 open = out.error.head<3>();
    for (int k = 0; k < 3; ++k) out.d.col(k) = R_WFp.col(type.axes[k]);
    for (int k = 0; k < out.held_along; ++k) out.error[k] = out.d.col(k).dot(open);
    out.r_P -= open;
  }
  for (int k = 0; k < out.held_turns(); ++k) {
    out.t[k] = R_WFp.col(type.held_square[k].parent_axis);
    out.u[k] = R_WFc.col(type.held_square[k].child_axis);
    out.n[k] = out.t[k].cross(out.u[k]);
    out.error[out.held_along + k] = out.t[k].dot(out.u[k]);
  }
}

namespace {

/// What stands in the bias as a vector at the point becomes the amounts of the rows that hold it along their directions.
void resolve_held(JointRows& rows) {
  const Vec3 v = rows.bias.head<3>();
  for (int k = 0; k < rows.held_along; ++k) rows.bias[k] = rows.d.col(k).dot(v);
}

}  // namespace

void joint_bias(const Twist& P, const Twist& C, JointRows& out) {
  out.bias.head<3>() = C.w.cross(C.w.cross(out.r_C)) - P.w.cross(P.w.cross(out.r_P));
  if (out.held_along < 3) {
    // along directions that turn with the parent: Coriolis
    out.bias.head<3>() += 2 * P.w.cross(P.v + P.w.cross(out.r_P) - C.v - C.w.cross(out.r_C));
    resolve_held(out);
  }
  for (int k = 0; k < out.held_turns(); ++k)
    out.bias[out.held_along + k] = -(P.w.cross(out.t[k]).cross(out.u[k]) + out.t[k].cross(C.w.cross(out.u[k]))).dot(P.w - C.w);
}

void joint_velocity_error(const Twist& P, const Twist& C, JointRows& out) {
  out.bias.head<3>() = C.v + C.w.cross(out.r_C) - (P.v + P.w.cross(out.r_P));
  if (out.held_along < 3) resolve_held(out);
  for (int k = 0; k < out.held_turns(); ++k) out.bias[out.held_along + k] = -out.n[k].dot(P.w - C.w);
}

namespace {

/// What a row asks of the velocity of the joint's point and of the angular velocity, on (v, w) of a body with the lever r.
Vec6 on_body(const JointRows& rows, int k, const Vec3& r) {
  Vec6 row;
  if (k < rows.held_along) {
    const Vec3 d = rows.held_along == 3 ? Vec3(Vec3::Unit(k)) : Vec3(rows.d.col(k));
    row << d, r.cross(d);
  } else {
    row << Vec3::Zero(), rows.n[k - rows.held_along];
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

Vec3 along_held(const JointRows& rows, const Vec6& amounts) {
  if (rows.held_along == 3) return amounts.head<3>();
  Vec3 out = Vec3::Zero();
  for (int k = 0; k < rows.held_along; ++k) out += amounts[k] * rows.d.col(k);
  return out;
}

}  // namespace engine
