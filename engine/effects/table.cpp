// What the table of effects is asked for: all of them, and the plan of a model.
#include <array>

#include "engine/effects/effects.h"

namespace engine {

std::span<const Effect* const> effect_table() {
#define CRASHREEL_ADDRESS(effect) &(effect),
  static constexpr std::array kTable{CRASHREEL_EFFECTS(CRASHREEL_ADDRESS)};
#undef CRASHREEL_ADDRESS
  return kTable;
}

Plan compile(const Model& model) {
  Plan plan;
  for (const Effect* effect : effect_table()) {
    const Finding found = effect->look(model);
    const auto forced = model.settings.effects.find(effect->name);
    const Force force = forced == model.settings.effects.end() ? Force::automatic : forced->second;
    PlanLine line{effect->name, force == Force::on || (force == Force::automatic && found.called_for), force != Force::automatic,
                  found.reason, found.left_out};
    if (force == Force::off && found.called_for) {
      line.reason = "switched off by the author; the scene calls for it: " + found.reason;
      line.left_out = "all of it, without a bound: this is not the scene's result";
    }
    if (force == Force::on && !found.called_for) line.reason = "switched on by the author, with nothing to do: " + found.reason;
    if (line.active) plan.active.push_back(effect);
    plan.lines.push_back(std::move(line));
  }
  return plan;
}

}  // namespace engine
