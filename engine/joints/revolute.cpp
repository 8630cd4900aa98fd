// A hinge: turns about y of the joint frame.
#include "engine/joints/joint_type.h"

namespace engine {

template <>
JointType joint_type<JointKind::revolute>() {
  return {"revolute", "revolute", {0, 1, 2}, 3, {{{0, 1}, {2, 1}}}, 2, add_turn_about_y};
}

}  // namespace engine
