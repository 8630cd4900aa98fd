// Rigidly tied: no freedom at all.
#include "engine/joints/joint_type.h"

namespace engine {

template <>
JointType joint_type<JointKind::fixed>() {
  return {"fixed", "rigid", {0, 1, 2}, 3, {{{0, 1}, {1, 2}, {2, 0}}}, 3, [](const JointFrames&, JointCoordinates&) {}};
}

}  // namespace engine
