// A slider: the child's point slides along y of the parent's frame, and nothing turns.
#include "engine/joints/joint_type.h"

namespace engine {

template <>
JointType joint_type<JointKind::prismatic>() {
  return {"prismatic", "prismatic", {0, 2, 1}, 2, {{{0, 1}, {1, 2}, {2, 0}}}, 3, [](const JointFrames& at, JointCoordinates& out) {
            add_slide_along(Vec3::UnitY(), at, out);
          }};
}

}  // namespace engine
