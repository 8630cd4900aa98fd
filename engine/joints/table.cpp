// All kinds of joint, in the order of JointKind.
#include <utility>

#include "engine/joints/joint_type.h"

namespace engine {

const std::array<JointType, static_cast<std::size_t>(JointKind::count)> kJointTypes =
    []<std::size_t... K>(std::index_sequence<K...>) {
  return std::array{joint_type<static_cast<JointKind>(K)>()...};
}
(std::make_index_sequence<static_cast<std::size_t>(JointKind::count)>());

}  // namespace engine
