// A physical effect: its name, what in a Model calls for it, and the hooks of the step it takes part in. Adding one is a file in
// this folder, which ends with its registration, and a word in the table of table.cpp.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

#include "engine/effects/reach.h"
#include "engine/step_context.h"
#include "engine/world.h"

namespace engine {

/// What a model has for an effect.
struct Finding {
  bool called_for = false;
  std::string reason;    // the criterion with its value, whether it is called for or not
  std::string left_out;  // what the effect, on or off, does not compute, and how much that is worth; empty: nothing
};

/// What an effect did not compute in a run that is known.
struct LeftOut {
  std::string text;      // empty: nothing closer than Finding::left_out
  bool matters = false;  // enough to warn
};

/// Where an effect acts under a scheme that takes into its stages what it can.
struct Staged {
  bool some = false;        // of it acts within them
  std::string once_a_step;  // what does not: "wheels"; empty: nothing
};

/// A key of a scene that an effect brings with it; the loader, the reference and the schema read it from here.
struct SceneKey {
  const char* name;
  const char* unit;      // SI: "kg/m^3"; empty for a plain number
  int components;        // 1 or 3
  const char* fallback;  // as in a scene file, with ' for "; empty: left out, there is no input
  const char* doc;       // a sentence
  double lower = -std::numeric_limits<double>::infinity();
};

/// A section of the scene file that is an effect's own.
struct SceneSection {
  const char* name = "";  // empty: none
  const char* doc = "";
  std::span<const SceneKey> keys = {};
};

/// What the scene has under such a key, by "section.key"; null where it has no such section or key.
inline const Vec3* input(const Model& model, const std::string& key) {
  const auto found = model.inputs.find(key);
  return found == model.inputs.end() ? nullptr : &found->second;
}

/// An effect of one run. What follows from the model alone, and scratch, are members of the derived class, set by its constructor;
/// what changes from step to step is in the State: shared by several effects as a field there, an effect's own as its memory.
class Effect {
 public:
  explicit Effect(int self) : self_(self) {}
  virtual ~Effect() = default;
  Effect(const Effect&) = delete;

  /// Once, before the first step of a run that starts: its part of the state.
  virtual void begin(World&, State&) {}
  /// Start of every step: inputs that follow the clock, dynamic pruning. `step` [s] is the length it may have.
  virtual void before_step(World&, State&, double /*step*/) {}
  /// Appends contacts: they follow from poses alone. Called at the end of a step, where it shows how well the step kept them (what
  /// it found there serves the next step), and in the stages of `rk4` with the compliant law.
  virtual void find_contacts(ContactSearch&) {}
  /// The same for joint limits, which no stage asks for.
  virtual void find_limits(ContactSearch&) {}
  /// Appends conditions that also follow the clock or the length of the step: wheels, closed loops. Called at its start.
  virtual void find(StepContext&) {}
  /// Smooth forces on such trees at a stage of the integration: adds to `force` (6 per body). Schemes rk4 and adaptive ask for all
  /// that take part at once.
  virtual void add_forces(const World&, std::span<const int> /*trees*/, const std::vector<Pose>&, const std::vector<Twist>&,
                          std::vector<Vec6>& /*force*/) const {}
  /// Implicit joint resistance over the step: fills dampers and resistances.
  virtual void resist(StepContext&) {}
  /// Sees the end of a step the resistance has acted over; true when it has revised a damper and the impulses must be found again.
  virtual bool gave_way(StepContext&) { return false; }
  /// Energy [J] that springs of its own hold where the step would end: seen before it is accepted, and once for each step that is.
  virtual double stored(StepContext&) { return 0; }
  /// End of every step.
  virtual void after_step(StepContext&) {}

 protected:
  const int self_;  // index in the plan
};

/// An effect that keeps something of its own from step to step.
template <class M>
class EffectWith : public Effect {
 public:
  using Memory = M;
  using Effect::Effect;

 protected:
  Memory& memory(State& state) const { return state.memory[self_].template as<Memory>(); }
};

/// The hooks of the step.
enum class Hook : unsigned {
  begin = 1,
  before_step = 2,
  find_contacts = 4,
  find_limits = 8,
  find = 16,
  add_forces = 32,
  resist = 64,
  gave_way = 128,
  stored = 256,
  after_step = 512
};
static_assert(static_cast<unsigned>(Hook::after_step) == 1u << (kHooks - 1));

/// What is known of an effect before a run.
struct EffectKind {
  const char* name = "";
  Finding (*look)(const Model&) = nullptr;
  /// Finding::left_out once the run is known, in which the effect was active or not: closer than before it. Null: no closer.
  LeftOut (*left_out)(const Model&, const Recording&, bool active) = nullptr;
  /// May it give energy that its account did not take before: springs, surfaces that give way, the wind? Null: never.
  bool (*gives)(const Model&) = nullptr;
  /// Has it nothing to give over a whole run but what springs held at the start?
  bool passive = false;
  /// [s] before which it cannot matter, proved from the reach; infinity: not in this run. Null: from the start.
  double (*not_before)(const Model&, const Reach&) = nullptr;
  /// Where it acts under schemes rk4 and adaptive. Null: contacts where their law allows, stops of joints once a step, all else in
  /// the stages of any scheme.
  Staged (*staged)(const Model&) = nullptr;
  SceneSection section;
  std::unique_ptr<Effect> (*make)(World&, int self) = nullptr;
  EffectMemory (*first_memory)() = nullptr;
  unsigned hooks = 0;  // those it takes part in

  bool takes_part(Hook hook) const { return (hooks & static_cast<unsigned>(hook)) != 0; }
};

/// The registration of an effect, defined in registration.h: its file ends with `template struct Registered<Effect>;`.
template <class E>
struct Registered {
  static const EffectKind kind;
};

/// Calls a hook of every effect of the plan that takes part in it, counted and timed.
template <class Member, class... Arguments>
void call(World& world, Hook hook, Member member, Arguments&&... arguments) {
  for (const std::size_t e : world.taking_part(hook)) {
    const Meter::Span span(world.meter, e);
    ((*world.effects[e]).*member)(arguments...);
  }
}

/// Every effect there is, in the order of the step.
std::span<const EffectKind* const> effect_table();

}  // namespace engine
