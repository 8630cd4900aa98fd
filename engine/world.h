// What one run works with besides its State: the topology, the factorisations, the running effects, the log. Built from the model
// and its plan alone, so that a state may go on in another World. Its buffers are allocated once: a step allocates nothing.
#pragma once

#include <array>
#include <bit>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/contact/contact.h"
#include "engine/meter.h"
#include "engine/model/model.h"
#include "engine/plan.h"
#include "engine/simulate.h"
#include "engine/solver/articulation.h"
#include "engine/solver/constraint.h"
#include "engine/solver/contact_solver.h"
#include "engine/solver/loop_closure.h"
#include "engine/state.h"

namespace engine {

/// Conditions the buffers of a step have room for from the start: a step allocates nothing until there are more.
constexpr std::size_t kRoom = 128;

/// [-] of the step: instants nearer than this to the ends of a step are taken there.
constexpr double kSliver = 1e-3;

/// The moment at which a run falls farthest short of one of its bounds, and between whom.
struct Shortfall {
  double amount = 0, time = 0;
  int body_a = -1, body_b = -1;

  void note(double amount_now, double now, const Constraint& c) {
    if (amount_now > amount) *this = {amount_now, now, c.a.record, c.b.record};
  }
};

/// Two bodies that stand inside each other before anything has moved.
struct Overlap {
  int a = -1, b = -1;
  double depth = 0;  // [m]
};

/// What a run tells besides its motion. The step reads none of it.
struct RunLog {
  /// An effect has had something to look after, or has exchanged an impulse over the step to `time` [s].
  void note_reach(int effect, double time) {
    PlanLine::Acted& of = acted[static_cast<std::size_t>(effect)];
    if (of.in_reach < 0) of.in_reach = time;
  }
  void note_action(int effect, double time) {
    PlanLine::Acted& of = acted[static_cast<std::size_t>(effect)];
    note_reach(effect, time);
    if (of.first < 0) of.first = time;
    of.last = time;
  }

  Diagnostics diagnostics;
  Shortfall unsettled;            // [m/s] conditions that the solver left unmet
  Shortfall gain;                 // [J] that an effect gave in a step though it has none to give, and at which bodies most
  int gained_by = -1;             // that effect
  std::vector<Overlap> overlaps;  // at the start
  std::vector<Event> events;
  std::vector<PlanLine::Acted> acted;    // per effect of the plan
  std::vector<ContactRecord> exchanges;  // at an instant and by no constraint (Kudlich-Slibar), over the whole run
  std::optional<Failure> failure;

  double overlap_at_start(int a, int b) const;  // [m] 0 if they stood apart
};

class Effect;
enum class Hook : unsigned;
constexpr int kHooks = 10;

/// Who waits or sleeps without moving costs nothing: no loop of the step goes over them. Follows from the state, as `awake` does.
struct StillBodies {
  std::vector<int> others;      // all bodies but them, in order
  double potential = 0;         // [J] gravitational energy of the still ones
  long changes = 0;             // how often these lists were made
  std::vector<char> chosen_of;  // who waited, slept or had broken when they were
};

struct World {
  World(const Model&, const Plan&, const RunOptions&);
  ~World();
  World(const World&) = delete;

  /// Effects of the plan that take part in a hook of the step, in order.
  const std::vector<std::size_t>& taking_part(Hook hook) const {
    return of_hook_[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(hook)))];
  }

  const Model& model;
  const Plan& plan;
  Topology topology;
  Articulation smooth;   // of the stage at hand, then of the end of the step; undamped
  Articulation impulse;  // at the start of the step, first undamped, then with joint resistance
  LoopClosure loops;     // of the joints cut from the trees
  ContactSolver solver;

  std::vector<double> tree_mass;  // [kg] per tree
  std::vector<double> reach;      // [m] per body: radius of its shape about the centre, 0 without
  std::vector<char> awake;        // per body: takes part in this step; follows from the state
  std::vector<int> active_trees;
  std::vector<int> awake_joints;  // one of whose bodies takes part
  KnownCoordinates coordinates;
  StillBodies still;
  ContactPairs pairs;
  std::vector<std::unique_ptr<Effect>> effects;  // of the plan
  std::vector<char> gives;                       // of each: may it give energy?
  Meter meter;
  RunLog log;

 private:
  std::array<std::vector<std::size_t>, kHooks> of_hook_;  // by the bit of the hook
};

/// Told of what stands inside something else before anything has moved: two bodies (-1: the ground) and their gap [m].
void warn_of_overlap(World&, int a, int b, double gap);

/// Which trees take part: those of persons in the zero condition and those asleep do not.
void choose_trees(World&, const State&);

/// Copies what moves, or all bodies.
template <class T>
void copy_moving(const World& world, const std::vector<T>& from, std::vector<T>& to, bool all) {
  if (all) {
    to = from;
    return;
  }
  for (const int b : world.still.others) to[b] = from[b];
}

/// Calls act(body) for every body of these trees.
template <class Act>
void for_bodies_of(const World& world, std::span<const int> trees, Act&& act) {
  for (const int tree : trees)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) act(world.topology.links[l].body);
}

/// Calls act(body) for every body of the trees that take part.
template <class Act>
void for_awake_bodies(const World& world, Act&& act) {
  for_bodies_of(world, world.active_trees, act);
}

/// Calls act(trees, looped) for each tree that takes part by itself, then for all together that closed loops hold.
template <class Act>
void for_joined_trees(const World& world, Act&& act) {
  const bool any = world.loops.any();
  for (const int tree : world.active_trees)
    if (!(any && world.loops.holds(tree))) act(std::span(&tree, 1), false);
  if (any) act(std::span(world.loops.trees()), true);
}

/// Kinetic and gravitational energy [J] of all bodies that move.
double kinetic_energy(const Model&, const Motion&);
double potential_energy(const Model&, const Motion&);
/// The same of all, without a look at what is still.
double kinetic_energy(const World&, const Motion&);
/// Both together, without a look at what is still.
double mechanical_energy(const World&, const Motion&);

}  // namespace engine
