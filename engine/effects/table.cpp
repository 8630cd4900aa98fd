// The table of all effects, in the order of the step, and the plan of a model. Each is defined in the file of its name.
#include <array>

#include "engine/effects/effect.h"

namespace engine {
namespace {

template <class... Effects>
constexpr std::array<const EffectKind*, sizeof...(Effects)> table() {
  return {&Registered<Effects>::kind...};
}

}  // namespace

constexpr auto kTable = table<class ZeroCondition,    //
                              class Sleep,            //
                              class Gravity,          //
                              class AirDrag,          //
                              class Joints,           //
                              class JointLimits,      //
                              class JointResistance,  //
                              class JointLoops,       //
                              class Driver,           //
                              class Tyres,            //
                              class GroundContact,    //
                              class TerrainContact,   //
                              class MeshContact,      //
                              class SelfContact,      //
                              class BodyContact,      //
                              class BodyworkContact,  //
                              class KudlichSlibar>();

std::span<const EffectKind* const> effect_table() {
  return kTable;
}

Plan compile(const Model& model) {
  Plan plan;
  for (const EffectKind* effect : effect_table()) {
    const Finding found = effect->look(model);
    const auto forced = model.settings.effects.find(effect->name);
    const Force force = forced == model.settings.effects.end() ? Force::automatic : forced->second;
    PlanLine line{effect->name,
                  force == Force::on || (force == Force::automatic && found.called_for),
                  force != Force::automatic,
                  found.reason,
                  found.left_out,
                  found.called_for};
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
