// The articulation angles of a joint and how they answer a relative angular velocity.
//
// R_FpFc = S T with swing S = exp of a rotation vector (phi_x, phi_y, 0) and twist T about z by psi. The relative angular velocity
// in Fp is J_l(phi) (phi_x', phi_y', 0) + S z psi', J_l the left Jacobian of the rotation vector: three columns, inverted. Singular
// only at a swing of 180 deg, which the joint frames keep out of every range (model/joint.h).
#pragma once

#include "engine/model/joint.h"

namespace engine {

struct JointAngles {
  Vec3 angle = Vec3::Zero();             // [rad] swing x, swing y, twist z
  Mat3 gradient_W = Mat3::Zero();        // column i: rate of angle i = column i . (w_C - w_P), world
  bool free[3] = {false, false, false};  // which of the three this joint kind has
};

JointAngles joint_angles(const Joint&, const Pose& X_WP, const Pose& X_WC);

}  // namespace engine
