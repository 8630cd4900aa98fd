// A cardan cross: y of the parent's frame and x of the child's stay at right angles. R = R_y(alpha) R_x(beta).
#include "engine/joints/joint_type.h"
#include "engine/math/functions.h"

namespace engine {
namespace {

void cross_angles(const JointFrames& at, JointCoordinates& out) {
  const Mat3 R = (at.q_WFp.conjugate() * at.q_WFc).toRotationMatrix();
  out.value[1] = math::atan2(-R(2, 0), R(0, 0));
  out.value[0] = math::atan2(-R(1, 2), R(1, 1));
  out.gradient_W.col(1) = out.axes_W.col(1) = at.q_WFp.toRotationMatrix().col(1);
  out.gradient_W.col(0) = out.axes_W.col(0) = at.q_WFc * Vec3::UnitX();
  out.free[0] = out.free[1] = true;
}

}  // namespace

template <>
JointType joint_type<JointKind::universal>() {
  return {"universal", "universal", {0, 1, 2}, 3, {{{1, 0}}}, 1, cross_angles};
}

}  // namespace engine
