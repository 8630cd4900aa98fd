// Joints are conditions of the factorisation itself; this effect names them in the plan. Without it
// the bodies come apart.
#include <array>

#include "engine/effects/registration.h"
#include "engine/effects/words.h"
#include "engine/joints/joint_type.h"

namespace engine {
namespace {

Finding look_for_joints(const Model& model) {
  if (model.joints.empty()) return {false, "no joints", ""};
  std::array<std::size_t, static_cast<std::size_t>(JointKind::count)> count{};
  for (const Joint& joint : model.joints) ++count[static_cast<std::size_t>(joint.kind)];
  std::string kinds;
  for (std::size_t k = 0; k < count.size(); ++k)
    if (count[k] > 0)
      kinds += (kinds.empty() ? "" : ", ") + std::to_string(count[k]) + " " + type_of(static_cast<JointKind>(k)).in_plan;
  return {true, counted(model.joints.size(), "joint") + ": " + kinds, ""};
}

}  // namespace

class Joints final : public Effect {
 public:
  static constexpr const char* kName = "joints";
  static Finding look(const Model& model) { return look_for_joints(model); }

  Joints(const World&, int self) : Effect(self) {}
};
template struct Registered<Joints>;

}  // namespace engine
