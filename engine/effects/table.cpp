// The one list of all effects, in the order of the step.
#include <array>

#include "engine/effects/effects.h"

namespace engine {

std::span<const Effect* const> effect_table() {
  static constexpr std::array kTable{
      &kZeroConditionEffect, &kGravityEffect,     &kJointsEffect,          &kJointLimitsEffect,    &kJointResistanceEffect,
      &kJointLoopsEffect,    &kTyresEffect,       &kGroundContactEffect,   &kTerrainContactEffect, &kMeshContactEffect,
      &kSelfContactEffect,   &kBodyContactEffect, &kBodyworkContactEffect, &kKudlichSlibarEffect,
  };
  return kTable;
}

Plan compile(const Model& model) {
  Plan plan;
  for (const Effect* effect : effect_table()) {
    const auto reason = effect->called_for(model);
    const auto forced = model.settings.effects.find(effect->name);
    const Force force = forced == model.settings.effects.end() ? Force::automatic : forced->second;
    PlanLine line{effect->name, force == Force::on || (force == Force::automatic && reason), force != Force::automatic,
                  reason.value_or("nothing in the scene calls for it")};
    if (force == Force::off) line.reason = "forced off by the scene" + (reason ? "; it is called for: " + *reason : std::string());
    if (force == Force::on && !reason) line.reason = "forced on by the scene; nothing calls for it";
    if (line.active) plan.active.push_back(effect);
    plan.lines.push_back(std::move(line));
  }
  return plan;
}

}  // namespace engine
