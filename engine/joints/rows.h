// What a joint holds, as rows of the Jacobian, eq. (62), with their error and velocity-dependent right-hand side, and what it
// leaves free: its motion subspace.
//
// Position: the child's point c stays at the parent's, along world axes; of a joint that slides d . (p_P + R_P x_PF - c) = 0 for
// the directions d of the parent's frame that it holds, with the parent's lever to c. Attitude: pairs (t fixed in P, u fixed in C)
// with t.u = 0; the row on (w_P - w_C) is n = t x u.
// J V = 0 differentiated gives J a = g with g = -Jdot V; leaving g out costs an order.
#pragma once

#include <array>

#include "engine/joints/joint_type.h"

namespace engine {

constexpr int kMaxJointRows = 6;

struct JointRows {
  int count = 0;
  int held_along = 3;                           // of them on the point; the rest on the attitude
  Vec3 r_P = Vec3::Zero(), r_C = Vec3::Zero();  // [m] from the centre of parent and child to the joint's point, world axes
  Mat3 d = Mat3::Identity();                    // directions of a joint that slides: the first `held_along` held, the others free
  std::array<Vec3, 3> t, u, n;                  // of the rows on the attitude
  Vec6 error = Vec6::Zero();                    // C(q) [m], [-]
  Vec6 bias = Vec6::Zero();                     // g [m/s^2], [1/s^2]

  int held_turns() const { return count - held_along; }
  int slides() const { return 3 - held_along; }
  int turns() const { return 3 - held_turns(); }
};

int row_count(JointKind);

/// Fills all but the bias. A joint to the world passes an identity pose for the parent.
void joint_rows(const Joint&, const Pose& X_WP, const Pose& X_WC, JointRows& out);

/// Of a parent that is the world.
inline const Twist kStill{};

/// Fills the bias with g for the velocities given. Call after joint_rows.
void joint_bias(const Twist& V_WP, const Twist& V_WC, JointRows& out);

/// Fills the bias with what would take out the velocity that the joint forbids.
void joint_velocity_error(const Twist& V_WP, const Twist& V_WC, JointRows& out);

/// Row k on (v, w) of the parent and of the child.
Vec6 row_on_parent(const JointRows&, int k);
Vec6 row_on_child(const JointRows&, int k);

/// What the rows on the point make of amounts, as one vector [world].
Vec3 along_held(const JointRows&, const Vec6& amounts);

/// How far the joint is open [m].
inline double gap_of(const JointRows& rows) {
  return rows.held_along == 3 ? rows.error.head<3>().norm() : rows.error.head(rows.held_along).norm();
}

/// Motion subspace: columns (v of the joint's point, w) of the child against the parent, slides before turns, then zeros.
inline Mat6 motion_subspace(const JointRows& rows) {
  Mat6 S = Mat6::Zero();
  const int slides = rows.slides();
  for (int k = 0; k < slides; ++k) S.col(k).head<3>() = rows.d.col(rows.held_along + k);
  switch (rows.held_turns()) {
    case 0:
      for (int k = 0; k < 3; ++k) S(3 + k, slides + k) = 1;
      break;
    case 1:
      S.col(slides).tail<3>() = rows.t[0];
      S.col(slides + 1).tail<3>() = rows.u[0];
      break;
    case 2:
      S.col(slides).tail<3>() = rows.u[0];
      break;
    default:
      break;
  }
  return S;
}

}  // namespace engine
