// Joints are conditions of the factorisation itself; this effect names them in the plan. They cannot be had without it.
#include "engine/effects/effects.h"

namespace engine {
namespace {

std::optional<std::string> called_for(const Model& model) {
  if (model.joints.empty()) return std::nullopt;
  return std::to_string(model.joints.size()) + " joints hold bodies together";
}

}  // namespace

const Effect kJointsEffect{.name = "joints", .called_for = called_for};

}  // namespace engine
