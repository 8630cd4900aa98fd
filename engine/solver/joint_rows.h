// The conditions of one joint as rows of the Jacobian, eq. (62), with their error and velocity-dependent right-hand side.
//
// Position: p_P + R_P x_PF = p_C + R_C x_CF, three rows. Attitude: pairs (t fixed in P, u fixed in C) with t.u = 0; the row on
// (w_P - w_C) is t x u. revolute has two such pairs (x and z of P against y of C), universal one, fixed three.
// J V = 0 differentiated gives J a = g with g = -Jdot V; leaving g out costs an order.
#pragma once

#include "engine/model/joint.h"

namespace engine {

constexpr int kMaxJointRows = 6;

struct JointRows {
  int count = 0;
  Mat6 J_P;    // first `count` rows, on (v, w) of the parent
  Mat6 J_C;    // on (v, w) of the child
  Vec6 error;  // C(q) [m], [-]
  Vec6 bias;   // g [m/s^2], [1/s^2]
};

int row_count(JointKind);

/// Fills J_P, J_C and error. A joint to the world passes an identity pose for the parent; its J_P is then not to be used.
void joint_rows(const Joint&, const Pose& X_WP, const Pose& X_WC, JointRows& out);

/// Fills bias for the angular velocities given. Call after joint_rows.
void joint_bias(const Joint&, const Pose& X_WP, const Pose& X_WC, const Vec3& w_P, const Vec3& w_C, JointRows& out);

}  // namespace engine
