// Until the first external impact gravity and joint forces of a person balance: it keeps its pose, stands or walks on as one, and
// costs a bounding test a step. The first touch by anything but its support releases it (source 000, "zero condition").
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/contact/mesh_points.h"
#include "engine/contact/round_tyre.h"
#include "engine/effects/body_pairs.h"
#include "engine/effects/registration.h"
#include "engine/effects/riding.h"
#include "engine/effects/support.h"
#include "engine/effects/underfoot.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

Finding look_for_zero_condition(const Model& model) {
  std::vector<std::string> waiting;
  for (const Person& person : model.persons)
    if (person.zero_condition) waiting.push_back(person.name);
  if (model.persons.empty()) return {false, "no person", ""};
  if (waiting.empty()) return {false, "zero_condition = false for " + counted(model.persons.size(), "person"), ""};
  const std::string keep = waiting.size() == 1 ? " keeps pose and speed" : " keep pose and speed";
  return {true, listed(waiting) + keep + " until something other than the support touches",
          "until then gravity, joints, support and the air, which are taken to be in balance: who walks or rides keeps its speed, "
          "on slopes too, but where a driver brakes, drives or steers"};
}

/// Whose a body is: a person's own, or joined to one, a pram or a bag.
int person_of(const World& world, int body) {
  const int own = world.model.bodies[body].person, tree = world.topology.tree_of_body[body];
  return own >= 0 || tree < 0 ? own : world.topology.trees[tree].person;
}

bool waits(const World& world, const State& state, int body) {
  const int person = person_of(world, body);
  return person >= 0 && !state.released[person];
}

/// What is joined to each person, parts and mount left out.
std::vector<std::vector<int>> held_by(const World& world) {
  std::vector<std::vector<int>> held(world.model.persons.size());
  for (const Topology::Tree& tree : world.topology.trees)
    for (int l = tree.begin; l < tree.end; ++l)
      if (const int b = world.topology.links[l].body; tree.person >= 0 && world.model.bodies[b].person < 0)
        held[tree.person].push_back(b);
  return held;
}

/// Stands where it is while it waits.
bool stands(const World& world, const State& state, const Person& person) {
  const int body = person.bodies.front();
  return person.mount < 0 && !world.awake[body] && state.V_WB[body].v.isZero(0);
}

void release(World& world, State& state, int body, int by, const Vec3& point) {
  const std::vector<int>& tree = world.topology.tree_of_body;
  for (int p = 0; p < static_cast<int>(state.released.size()); ++p) {
    const bool own = p == person_of(world, body);
    const int root = world.model.persons[p].bodies.front();
    const bool joined = tree[body] >= 0 && tree[root] == tree[body];  // a child in arms
    if (state.released[p] || !(own || joined)) continue;
    state.released[p] = 1;
    world.log.events.push_back({state.time, "release", own ? body : root, by, point, 0});
  }
}

Vec3 velocity_at(const Outlook& outlook, int body, const Vec3& point) {
  return outlook.at.V_WB[body].v + outlook.at.V_WB[body].w.cross(point - outlook.at.X_WB[body].p);
}

/// Would the two close their gap within this step? It touches who has rubber against them, that does not press yet.
bool closes(const Outlook& outlook, const SurfaceContact& touch, const ShapePair& shapes, int a, int b) {
  const double gives = shapes.b == ShapeKind::tyre && yields_as_rubber(outlook.world.model, a) ? kTyreGives : 0;
  const double closing = -touch.normal.dot(velocity_at(outlook, a, touch.p_a) - velocity_at(outlook, b, touch.p_a));
  return touch.gap - gives - closing * outlook.within <= 0 && closing > 0;
}

/// What has come to bear somebody since the start, or bore them then, moves away under them.
bool moves_away(const Outlook& outlook, const SurfaceContact& touch, int a, int b) {
  constexpr double kOn = 5e-3;  // [m]
  const Model& model = outlook.world.model;
  if (!is_part(model, a) || b < 0 || model.bodies[b].fixed || touch.gap > kOn || touch.normal.z() < kBears) return false;
  return moves_from_under(model, outlook.at, model.bodies[a].person, b, touch.p_b);
}

/// Sets free who of a pair waits and is touched; what already overlaps is told of where `warn` asks for it. What somebody goes over
/// is no touch.
void watch(const Outlook& outlook, const PairKind& kind, const ContactPair& pair, bool warn, const Underfoot* underfoot = nullptr) {
  World& world = outlook.world;
  State& state = outlook.state;
  const int person = person_of(world, pair.a);
  if (person >= 0 && person == person_of(world, pair.b)) return;  // itself, what it rides, and what it holds
  if (!waits(world, state, pair.a) && !waits(world, state, pair.b)) return;
  for (const SurfaceContact& touch : kind.touches(outlook, pair)) {
    if (moves_away(outlook, touch, pair.a, pair.b)) {
      release(world, state, pair.a, pair.b, touch.p_a);
      continue;
    }
    if (!closes(outlook, touch, kind.shapes, pair.a, pair.b)) {
      if (warn) warn_of_overlap(world, pair.a, pair.b, touch.gap);
      continue;
    }
    if (underfoot && person >= 0 && underfoot->carries(world.model, state, person, pair.b, touch.p_b)) continue;
    if (waits(world, state, pair.a)) release(world, state, pair.a, pair.b, touch.p_a);
    if (waits(world, state, pair.b)) release(world, state, pair.b, pair.a, touch.p_b);
  }
}

}  // namespace

class ZeroCondition final : public Effect {
 public:
  static constexpr const char* kName = "zero_condition";
  static Finding look(const Model& model) { return look_for_zero_condition(model); }

  ZeroCondition(const World& world, int self)
      : Effect(self),
        wheeled_(wheeled_pairs(world.model)),
        underfoot_(world.model),
        held_(held_by(world)),
        supports_(supports_at_start(world.model)),
        first_touch_(reach_of(world.model).first_touch) {
    walkers_.reserve(world.model.persons.size());
  }

  /// What is joined to somebody waits with them if it moves as they do. Else it pulls, and so does a vehicle that is no mount.
  void begin(World& world, State& state) override {
    constexpr double kSame = 1e-6;  // [m/s] and [rad/s]
    for (std::size_t p = 0; p < held_.size(); ++p) {
      const int root = world.model.persons[p].bodies.front();
      for (const int b : held_[p]) {
        const Twist& V = state.V_WB[b];
        const bool along = (V.v - state.V_WB[root].v).norm() < kSame && V.w.norm() < kSame;
        if (state.released[p] || (along && world.model.bodies[b].vehicle < 0)) continue;
        release(world, state, root, b, state.X_WB[b].p);
        world.log.diagnostics.warnings.push_back(world.model.persons[p].name + " does not wait to be touched: " +
                                                 world.model.bodies[b].name + ", which is joined, pulls from the start");
      }
    }
  }

  void before_step(World& world, State& state, double step) override {
    for (const StoodOn& s : supports_) {
      const Vec3 place = state.X_WB[s.on] * s.place;
      if (!state.released[s.person] && moves_from_under(world.model, state, s.person, s.on, place))
        release(world, state, s.part, s.on, place);
    }
    if (state.time > 0 && state.time + step < first_touch_) return;  // proved: nothing touches
    if (std::all_of(state.released.begin(), state.released.end(), [](char r) { return r != 0; })) return;
    const bool warn = state.time == 0 && !yields(world.model.settings.contact_law, true);
    const Outlook outlook{world, state, state, step};
    ContactPairs& pairs = world.pairs;
    pairs.look(outlook);
    for (std::size_t i = 0; i < pairs.bodywork.size(); ++i) {  // a mount struck by another mesh sets its rider free
      const auto [a, b] = pairs.bodywork[i];
      watch(outlook, mesh_on_mesh_, {a, b, i}, false);
      watch(outlook, mesh_on_mesh_, {b, a, i}, false);
    }
    for (const std::size_t r : pairs.in_reach.mesh)
      for (std::size_t i = pairs.mesh_runs[r].begin; i < pairs.mesh_runs[r].end; ++i)
        watch(outlook, on_mesh_, {pairs.mesh[i].body, pairs.mesh[i].mesh_body, i}, warn, &underfoot_);
    if (!state.wheels.empty())
      for (const std::size_t i : pairs.in_reach.tyres)
        watch(outlook, on_tyre_, {pairs.tyres[i].body, pairs.tyres[i].vehicle_body, i}, false);
    for (const BodyPair& pair : wheeled_) watch(outlook, tyre_on_tyre_, {pair.a, pair.b}, false);
    for (const std::size_t r : pairs.in_reach.round) {
      const BodyPairRun& run = pairs.round[r];
      list_pairs(world, r, state.contact_memory.round[r]);
      for (std::size_t i = 0; i < run.pairs.size(); ++i) watch(outlook, rounds_, {run.pairs[i].a, run.pairs[i].b, i, r}, warn);
    }
  }

  /// Walks, or rides, on as one.
  void after_step(StepContext& step) override {
    World& world = step.world;
    State& state = step.state;
    if (std::exchange(listed_, world.still.changes) != world.still.changes) list_walkers(world, state);
    for (const int p : walkers_) {
      if (!underfoot_.level() && !climb(step, p)) continue;
      const int mount = world.model.persons[p].mount;
      if (mount >= 0 && !world.awake[mount]) {
        ride(step, p, self_);
        continue;
      }
      double fallen = 0;  // [J] what gravity would have given: whoever walks keeps their speed
      for (const auto* bodies : {&world.model.persons[p].bodies, &held_[p]})
        for (const int b : *bodies) {
          if (world.awake[b]) continue;
          const Vec3 way = step.length * state.V_WB[b].v;
          state.X_WB[b].p += way;
          fallen += world.model.bodies[b].mass * world.model.settings.gravity.dot(way);
        }
      book(state, self_, -fallen);
    }
  }

 private:
  const PairKind& rounds_ = pair_kind({ShapeKind::round, ShapeKind::round});
  const PairKind& on_mesh_ = pair_kind({ShapeKind::round, ShapeKind::mesh});
  const PairKind& on_tyre_ = pair_kind({ShapeKind::round, ShapeKind::tyre});
  const PairKind& tyre_on_tyre_ = pair_kind({ShapeKind::tyre, ShapeKind::tyre});
  const PairKind& mesh_on_mesh_ = pair_kind({ShapeKind::mesh, ShapeKind::mesh});
  void list_walkers(const World& world, const State& state) {
    walkers_.clear();
    for (int p = 0; p < static_cast<int>(world.model.persons.size()); ++p)
      if (!state.released[p] && !stands(world, state, world.model.persons[p])) walkers_.push_back(p);
  }

  /// Has who walks or rides go up and down with the ground; false where it falls off an edge, or over one.
  bool climb(StepContext& step, int p) {
    World& world = step.world;
    State& state = step.state;
    const Person& person = world.model.persons[p];
    const auto rise = underfoot_.rise(world.model, state, p);
    if (!rise) {
      release(world, state, person.hips, -1, state.X_WB[person.hips].p);
      return false;
    }
    const Vec3 v = state.V_WB[person.hips].v;
    const double up = *rise * v.head<2>().norm();
    double given = 0;
    const auto lift = [&](int b) {
      given += 0.5 * world.model.bodies[b].mass * (up * up - v.z() * v.z());
      state.V_WB[b].v.z() = up;
    };
    for (const int b : person.bodies) lift(b);
    for (const int b : held_[p]) lift(b);
    if (person.mount >= 0) lift(person.mount);
    book(state, self_, given);
    return true;
  }

  const std::vector<BodyPair> wheeled_;
  const Underfoot underfoot_;
  const std::vector<std::vector<int>> held_;  // by persons
  const std::vector<StoodOn> supports_;       // of those who wait
  const double first_touch_;                  // [s] proved
  std::vector<int> walkers_;                  // who waits and moves on
  long listed_ = 0;                           // StillBodies::changes when they were
};
template struct Registered<ZeroCondition>;

}  // namespace engine
