// A ball in its socket: all turns.
#include "engine/joints/joint_type.h"

namespace engine {

template <>
JointType joint_type<JointKind::spherical>() {
  return {"spherical", "spherical", {0, 1, 2}, 3, {}, 0, add_swing_and_twist};
}

}  // namespace engine
