// A sleeve on a rod: slides along y of the parent's frame and turns about it, each for itself.
#include "engine/joints/joint_type.h"

namespace engine {

template <>
JointType joint_type<JointKind::cylindrical>() {
  return {"cylindrical", "cylindrical", {0, 2, 1}, 2, {{{0, 1}, {2, 1}}}, 2, [](const JointFrames& at, JointCoordinates& out) {
            add_turn_about_y(at, out);
            add_slide_along(Vec3::UnitY(), at, out);
          }};
}

}  // namespace engine
