// A ball in its socket with limits and resistance: what joins the parts of a person.
#include "engine/joints/joint_type.h"

namespace engine {

template <>
JointType joint_type<JointKind::ragdoll>() {
  return {"ragdoll", "spherical with limits", {0, 1, 2}, 3, {}, 0, add_swing_and_twist};
}

}  // namespace engine
