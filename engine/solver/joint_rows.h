// The conditions of one joint as rows of the Jacobian, eq. (62), with their error and velocity-dependent right-hand side.
//
// Position: p_P + R_P x_PF = p_C + R_C x_CF, three rows on the velocities of the joint's point seen from either side. Attitude:
// pairs (t fixed in P, u fixed in C) with t.u = 0; the row on (w_P - w_C) is n = t x u. revolute has two such pairs (x and z of P
// against y of C), universal one, fixed three.
// J V = 0 differentiated gives J a = g with g = -Jdot V; leaving g out costs an order.
#pragma once

#include <array>

#include "engine/model/joint.h"

namespace engine {

constexpr int kMaxJointRows = 6;

struct JointRows {
  int count = 0;
  Vec3 r_P = Vec3::Zero(), r_C = Vec3::Zero();  // [m] from the centre of parent and child to the joint's point, world axes
  std::array<Vec3, 3> t, u, n;                  // the first count - 3
  Vec6 error = Vec6::Zero();                    // C(q) [m], [-]
  Vec6 bias = Vec6::Zero();                     // g [m/s^2], [1/s^2]
};

int row_count(JointKind);

/// Fills all but the bias. A joint to the world passes an identity pose for the parent.
void joint_rows(const Joint&, const Pose& X_WP, const Pose& X_WC, JointRows& out);

/// Fills the bias for the angular velocities given. Call after joint_rows.
void joint_bias(const Vec3& w_P, const Vec3& w_C, JointRows& out);

/// Row k on (v, w) of the parent and of the child.
Vec6 row_on_parent(const JointRows&, int k);
Vec6 row_on_child(const JointRows&, int k);

}  // namespace engine
