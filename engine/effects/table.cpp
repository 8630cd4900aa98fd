// The table of all effects, in the order of the step, and the plan of a model. Each is defined in the file of its name.
#include <algorithm>
#include <array>

#include "engine/effects/effect.h"
#include "engine/effects/words.h"

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

namespace {

Force forced_of(const Model& model, const char* effect) {
  const auto forced = model.settings.effects.find(effect);
  return forced == model.settings.effects.end() ? Force::automatic : forced->second;
}

/// What the scene calls for but cannot reach in time is off, with the proof.
void prove_needless(const Model& model, const EffectKind& effect, const Reach& reach, PlanLine& line) {
  if (!line.called_for || !effect.not_before) return;
  line.not_before = effect.not_before(model, reach);
  if (line.forced || line.not_before < model.settings.duration) return;
  line.active = line.called_for = false;
  const std::string what = reach.all_bodies_wait ? "nothing can touch who waits" : "no two things can touch";
  const std::string why = reach.who.empty() ? what : what + " before, nearest are " + reach.who;
  line.reason = "cannot matter within " + number(model.settings.duration) + " s (" + why + "); " + line.reason;
  line.left_out = reach.all_bodies_wait ? "nothing but what zero_condition takes to be in balance"
                                        : "nothing: the bound on every speed is that of energy and drive";
}

Staged staged_of(const EffectKind& effect, const Model& model) {
  if (effect.staged) return effect.staged(model);
  const bool in_stages = contacts_in_stages(model.settings);
  if (effect.takes_part(Hook::find_contacts)) return {in_stages, in_stages ? "" : "contacts"};
  return {false, effect.takes_part(Hook::find_limits) ? "stops of joints" : ""};
}

/// Who asks for rk4 is told what of it is left.
void find_scheme(const Model& model, Plan& plan) {
  plan.integrated_by = model.settings.scheme;
  if (plan.integrated_by == Scheme::stepping) return;
  bool any_in_stages = false;
  for (const EffectKind* effect : plan.active) {
    const Staged staged = staged_of(*effect, model);
    any_in_stages = any_in_stages || staged.some;
    std::vector<std::string>& once = plan.once_a_step;
    if (!staged.once_a_step.empty() && std::find(once.begin(), once.end(), staged.once_a_step) == once.end())
      once.push_back(staged.once_a_step);
  }
  if (plan.integrated_by == Scheme::rk4 && !any_in_stages && !plan.once_a_step.empty()) plan.integrated_by = Scheme::stepping;
}

}  // namespace

Plan compile(const Model& model) {
  Plan plan;
  const Reach reach = reach_of(model);
  for (const EffectKind* effect : effect_table()) {
    const Finding found = effect->look(model);
    const Force force = forced_of(model, effect->name);
    PlanLine line;
    line.effect = effect->name;
    line.active = force == Force::on || (force == Force::automatic && found.called_for);
    line.forced = force != Force::automatic;
    line.reason = found.reason;
    line.left_out = found.left_out;
    line.called_for = found.called_for;
    if (force == Force::off && found.called_for) {
      line.reason = "switched off by the author; the scene calls for it: " + found.reason;
      line.left_out = "all of it, without a bound: this is not the scene's result";
    }
    if (force == Force::on && !found.called_for) line.reason = "switched on by the author, with nothing to do: " + found.reason;
    prove_needless(model, *effect, reach, line);
    if (line.active) plan.active.push_back(effect);
    plan.lines.push_back(std::move(line));
  }
  find_scheme(model, plan);
  return plan;
}

}  // namespace engine
