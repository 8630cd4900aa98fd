// The articulation angles of a joint and how they answer a relative angular velocity.
//
// R_FpFc = S T with swing S = exp of a rotation vector (phi_x, phi_y, 0) and twist T about z by psi. The relative angular velocity
// in Fp is J_l(phi) (phi_x', phi_y', 0) + S z psi', J_l the left Jacobian of the rotation vector: three columns, inverted. Singular
// only at a swing of 180 deg, which the joint frames keep out of every range (model/joint.h).
// Damping and friction do not follow the gradients, which are neither of unit length nor at right angles and grow without bound
// towards the singular swing: they act on the relative angular velocity along the axes of the frame half-way between the two,
// so that equal dampers resist every turn alike, whatever the angles, also in a joint without limits.
#pragma once

#include "engine/model/joint.h"

namespace engine {

struct JointAngles {
  Vec3 angle = Vec3::Zero();             // [rad] swing x, swing y, twist z
  Mat3 gradient_W = Mat3::Zero();        // column i: rate of angle i = column i . (w_C - w_P), world
  Mat3 axes_W = Mat3::Zero();            // column i: unit axis that damping and friction of angle i act about, world
  bool free[3] = {false, false, false};  // which of the three this joint kind has
};

JointAngles joint_angles(const Joint&, const Pose& X_WP, const Pose& X_WC);

}  // namespace engine
