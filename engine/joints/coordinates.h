// The coordinates of a joint and how they answer the relative motion of its bodies.
//
// Turns: R_FpFc = S T with swing S = exp of a rotation vector (phi_x, phi_y, 0) and twist T about z by psi. The relative angular
// velocity in Fp is J_l(phi) (phi_x', phi_y', 0) + S z psi', J_l the left Jacobian of the rotation vector: three columns, inverted.
// Singular only at a swing of 180 deg, which the joint frames keep out of every range (model/joint.h).
// Damping and friction do not follow the gradients, which are neither of unit length nor at right angles and grow without bound
// towards the singular swing: they act on the relative angular velocity along the axes of the frame half-way between the two,
// so that equal dampers resist every turn alike, whatever the angles, also in a joint without limits.
// Slide: along y of the parent's frame, of the child's point.
#pragma once

#include <vector>

#include "engine/model/joint.h"

namespace engine {

/// A joint and its bodies as they stand.
struct JointFrames {
  const Joint& joint;
  const Pose &X_WP, &X_WC;
  Quat q_WFp, q_WFc;
};

struct JointCoordinates {
  // swing x, swing y, twist z, slide
  Eigen::Vector4d value = Eigen::Vector4d::Zero();  // [rad], [rad], [rad], [m]
  Eigen::Matrix<double, 3, kCoordinates> gradient_W =
      decltype(gradient_W)::Zero();                                          // column i: rate of i = column . relative motion
  Eigen::Matrix<double, 3, kCoordinates> axes_W = decltype(axes_W)::Zero();  // unit axes that damping and friction act along
  std::array<bool, kCoordinates> free{};                                     // which of them this kind of joint has
  Vec3 r_P = Vec3::Zero(), r_C = Vec3::Zero();  // [m] from the centres of parent and child to the child's point, of one that slides
};

JointCoordinates joint_coordinates(const Joint&, const Pose& X_WP, const Pose& X_WC);

/// The coordinates of a run's joints where they were asked for last: what limits look at where a step ends, resistance looks at
/// where the next one begins.
class KnownCoordinates {
 public:
  void reset(std::size_t joints) { known_.assign(joints, {}); }

  /// Of joint `j` between bodies that stand so.
  const JointCoordinates& at(const Joint&, std::size_t j, const std::vector<Pose>& X_WB);

 private:
  struct Known {
    Pose X_WP, X_WC;
    JointCoordinates now;
    bool any = false;
  };
  std::vector<Known> known_;
};

/// Velocity of the child against the parent: w, and of one that slides v at the child's point. The world passes a zero twist.
Twist relative_motion(const JointCoordinates&, const Twist& V_WP, const Twist& V_WC);

/// What of a relative motion coordinate i sees: its angular velocity or, of a slide, its velocity.
inline const Vec3& part_of(const Twist& relative, int i) {
  return i == kSlide ? relative.v : relative.w;
}

/// Adds a force [N] on the child, and against it on the parent, at the point of a joint that slides.
void add_along_slide(const JointCoordinates&, const Joint&, const Vec3& force_W, std::vector<Vec6>& on_bodies);

/// Used by several kinds.
void add_turn_about_y(const JointFrames&, JointCoordinates&);
void add_swing_and_twist(const JointFrames&, JointCoordinates&);
void add_slide_along(const Vec3& axis_F, const JointFrames&, JointCoordinates&);  // of the parent's frame

}  // namespace engine
