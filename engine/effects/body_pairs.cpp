#include "engine/effects/body_pairs.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "engine/geometry/hyper_ellipsoid_pair.h"

namespace engine {
namespace {

/// Who is joined to whom, lower index first.
using Joined = std::vector<std::pair<int, int>>;

Joined joined_bodies(const Model& model) {
  Joined joined;
  for (const Joint& j : model.joints) joined.emplace_back(std::min(j.parent, j.child), std::max(j.parent, j.child));
  std::sort(joined.begin(), joined.end());
  return joined;
}

bool can_meet(const Model& model, const Joined& joined, int a, int b) {
  const Body& A = model.bodies[a];
  const Body& B = model.bodies[b];
  if (!std::holds_alternative<HyperEllipsoid>(A.shape) || !std::holds_alternative<HyperEllipsoid>(B.shape)) return false;
  if (A.fixed && B.fixed) return false;
  return !std::binary_search(joined.begin(), joined.end(), std::pair(std::min(a, b), std::max(a, b)));
}

/// Segments of one person that stand inside each other in the start pose (upper arm in the side of the torso, thighs at the
/// crotch) are so by the simplification of the figure: their contact would push the pose apart.
bool overlaps_at_start(const Model& model, int a, int b) {
  Vec3 guess = Vec3::Zero();
  return contact_of_pair(std::get<HyperEllipsoid>(model.bodies[a].shape), model.bodies[a].X_WB,
                         std::get<HyperEllipsoid>(model.bodies[b].shape), model.bodies[b].X_WB, 0.0, guess)
      .has_value();
}

}  // namespace

std::vector<BodyPair> pairs_within_persons(const Model& model, int effect) {
  const Joined joined = joined_bodies(model);
  std::vector<BodyPair> pairs;
  for (const Person& person : model.persons)
    for (std::size_t i = 0; i < person.bodies.size(); ++i)
      for (std::size_t k = i + 1; k < person.bodies.size(); ++k)
        if (can_meet(model, joined, person.bodies[i], person.bodies[k]) &&
            !overlaps_at_start(model, person.bodies[i], person.bodies[k]))
          pairs.push_back({effect, person.bodies[i], person.bodies[k], Vec3::Zero(), {}});
  return pairs;
}

namespace {

template <class What>
void for_each_pair_between_bodies(const Model& model, const What& what) {
  const Joined joined = joined_bodies(model);
  const int n = static_cast<int>(model.bodies.size());
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b) {
      const bool same_person = model.bodies[a].person >= 0 && model.bodies[a].person == model.bodies[b].person;
      if (!same_person && can_meet(model, joined, a, b)) what(a, b);
    }
}

}  // namespace

std::vector<BodyPair> pairs_between_bodies(const Model& model, int effect) {
  std::vector<BodyPair> pairs;
  for_each_pair_between_bodies(model, [&](int a, int b) { pairs.push_back({effect, a, b, Vec3::Zero(), {}}); });
  return pairs;
}

std::size_t count_pairs_between_bodies(const Model& model) {
  std::size_t count = 0;
  for_each_pair_between_bodies(model, [&](int, int) { ++count; });
  return count;
}

void add_pairs(World& world, std::vector<BodyPair> pairs) {
  // all of two trees together, so that one look at the trees does for all their pairs
  const auto trees = [&world](const BodyPair& pair) {
    return std::pair(world.topology.tree_of_body[pair.a], world.topology.tree_of_body[pair.b]);
  };
  std::vector<std::size_t> order(pairs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return trees(pairs[x]) < trees(pairs[y]); });
  world.body_pairs.reserve(world.body_pairs.size() + pairs.size());
  for (const std::size_t i : order) {
    const BodyPair& pair = pairs[i];
    const auto [tree_a, tree_b] = trees(pair);
    add_to_runs(world.body_pair_runs, pair.effect, tree_a, tree_b, world.body_pairs.size());
    world.body_pairs.push_back(pair);
  }
}

namespace {

void find_contacts_of(World& world, const State& state, const PairRun& run, ContactKind kind) {
  for (std::size_t i = run.begin; i < run.end; ++i) {
    BodyPair& pair = world.body_pairs[i];
    if (!world.awake[pair.a] && !world.awake[pair.b]) continue;
    const double margin = pair_margin(world, state, pair.a, pair.b);
    const double apart = (state.X_WB[pair.a].p - state.X_WB[pair.b].p).norm();
    if (apart > world.reach[pair.a] + world.reach[pair.b] + margin) continue;
    const Body& A = world.model.bodies[pair.a];
    const Body& B = world.model.bodies[pair.b];
    const bool frozen = (!world.awake[pair.a] && !A.fixed) || (!world.awake[pair.b] && !B.fixed);
    if (frozen) continue;  // waits or sleeps: those effects watch
    const Pose X_AB = state.X_WB[pair.a].inverse() * state.X_WB[pair.b];
    if (pair.clearance.beyond(margin, X_AB, world.reach[pair.b])) continue;
    pair.clearance.least = 0;
    const auto touch = contact_of_pair(std::get<HyperEllipsoid>(A.shape), state.X_WB[pair.a], std::get<HyperEllipsoid>(B.shape),
                                       state.X_WB[pair.b], margin, pair.normal_W, &pair.clearance.least);
    if (!touch) {
      pair.clearance.X = X_AB;
      continue;
    }
    const double mu = std::min(A.surface.friction_body.at(state.time), B.surface.friction_body.at(state.time));
    const double e = std::max(A.surface.restitution_body.at(state.time), B.surface.restitution_body.at(state.time));
    add_contact(world, state, *touch, pair.a, pair.b, run.effect, kind, mu, e);
  }
}

}  // namespace

void find_pair_contacts(World& world, const State& state, int effect, ContactKind kind) {
  world.nearness.look(world, state);
  for (const PairRun& run : world.body_pair_runs)
    if (run.effect == effect && world.nearness.close(run.tree_a, run.tree_b)) find_contacts_of(world, state, run, kind);
}

}  // namespace engine
