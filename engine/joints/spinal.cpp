// A ragdoll joint whose child gives way along z of the parent's frame: a neck under a blow on the crown.
#include "engine/joints/joint_type.h"

namespace engine {

template <>
JointType joint_type<JointKind::spinal>() {
  return {"spinal", "spherical with limits and a slide", {0, 1, 2}, 2, {}, 0, [](const JointFrames& at, JointCoordinates& out) {
            add_swing_and_twist(at, out);
            add_slide_along(Vec3::UnitZ(), at, out);
          }};
}

}  // namespace engine
