// A physical effect: its name, what in a Model calls for it, and the hooks of the step it takes part in.
// Adding one is one file in this folder and one line in effects.h.
#pragma once

#include <limits>
#include <span>
#include <string>

#include "engine/world.h"

namespace engine {

/// What a model has for an effect.
struct Finding {
  bool called_for = false;
  std::string reason;    // the criterion with its value, whether it is called for or not
  std::string left_out;  // what the effect, on or off, does not compute, and how much that is worth; empty: nothing
};

/// A key of a scene that an effect brings with it; the loader, the reference and the schema read it from here.
struct SceneKey {
  const char* name;
  const char* unit;      // SI: "kg/m^3"; empty for a plain number
  int components;        // 1 or 3
  const char* fallback;  // as in a scene file, with ' for "
  const char* doc;       // a sentence
  double lower = -std::numeric_limits<double>::infinity();
};

/// What the scene has under such a key, by "section.key"; null where it has no such section.
inline const Vec3* input(const Model& model, const std::string& key) {
  const auto found = model.inputs.find(key);
  return found == model.inputs.end() ? nullptr : &found->second;
}

struct Effect {
  const char* name = "";
  Finding (*look)(const Model&) = nullptr;
  /// Finding::left_out of an effect that was not in the plan, once the run is known: closer than before it.
  std::string (*left_out)(const Model&, const Recording&) = nullptr;
  /// A section of the scene file that is the effect's own, and its keys.
  const char* section = "";
  const char* section_doc = "";
  std::span<const SceneKey> keys = {};
  /// Once, before the first step: pairs, static loads. `self` is the effect's index in the plan.
  void (*begin)(World&, const State&, int self) = nullptr;
  /// Start of every step: inputs that follow the clock, dynamic pruning.
  void (*before_step)(World&, State&, int self) = nullptr;
  /// Appends contacts: they follow from poses alone. Called at the end of a step, where it shows how well the step kept them (what
  /// it found there serves the next step), and in the stages of `rk4` with the compliant law.
  void (*find_contacts)(World&, const State&, int self) = nullptr;
  /// The same for joint limits, which no stage asks for.
  void (*find_limits)(World&, const State&, int self) = nullptr;
  /// Appends constraints that also follow the clock or the length of the step: wheels, closed loops. Called at its start.
  void (*find)(World&, const State&, int self) = nullptr;
  /// Smooth forces at a stage of the integration: adds to `force` (6 per body).
  void (*add_forces)(const World&, const std::vector<Pose>&, const std::vector<Twist>&, std::vector<Vec6>& force,
                     int self) = nullptr;
  /// Implicit joint resistance over the step: fills dampers and resistances.
  void (*resist)(World&, const State&, int self) = nullptr;
  /// Sees the end of a step the resistance has acted over; true when it has revised a damper and the impulses must be found again.
  bool (*gave_way)(World&, const State& end) = nullptr;
  /// End of every step.
  void (*after_step)(World&, State&, int self) = nullptr;
};

/// Calls a hook of every effect of the plan that has it, counted and timed.
template <class Hook, class... Arguments>
void call(World& world, Hook Effect::*hook, Arguments&&... arguments) {
  for (std::size_t e = 0; e < world.plan.active.size(); ++e) {
    const Hook act = world.plan.active[e]->*hook;
    if (!act) continue;
    const Meter::Span span(world.meter, e);
    act(world, arguments..., static_cast<int>(e));
  }
}

/// Every effect there is, in the order of the step.
std::span<const Effect* const> effect_table();

}  // namespace engine
