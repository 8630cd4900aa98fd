#include "engine/effects/body_pairs.h"

#include <algorithm>
#include <map>
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

bool are_joined(const Joined& joined, int a, int b) {
  return std::binary_search(joined.begin(), joined.end(), std::pair(std::min(a, b), std::max(a, b)));
}

/// Two hyper-ellipsoids that are not both fixed.
bool are_rounds(const Model& model, int a, int b) {
  const Body &A = model.bodies[a], &B = model.bodies[b];
  return is_round(A) && is_round(B) && !(A.fixed && B.fixed);
}

bool can_meet(const Model& model, const Joined& joined, int a, int b) {
  return are_rounds(model, a, b) && !are_joined(joined, a, b);
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

std::vector<BodyPair> pairs_within_persons(const Model& model) {
  const Joined joined = joined_bodies(model);
  std::vector<BodyPair> pairs;
  for (const Person& person : model.persons)
    for (std::size_t i = 0; i < person.bodies.size(); ++i)
      for (std::size_t k = i + 1; k < person.bodies.size(); ++k)
        if (can_meet(model, joined, person.bodies[i], person.bodies[k]) &&
            !overlaps_at_start(model, person.bodies[i], person.bodies[k]))
          pairs.push_back({person.bodies[i], person.bodies[k]});
  return pairs;
}

namespace {

bool of_one_person(const Model& model, int a, int b) {
  return model.bodies[a].person >= 0 && model.bodies[a].person == model.bodies[b].person;
}

bool can_meet_between(const Model& model, const Joined& joined, int a, int b) {
  return a < b && !of_one_person(model, a, b) && can_meet(model, joined, a, b);
}

/// In ascending order; of tree -1 those that are fixed.
std::vector<int> bodies_of(const Topology& topology, int tree) {
  std::vector<int> bodies;
  for (int b = 0; b < static_cast<int>(topology.tree_of_body.size()); ++b)
    if (topology.tree_of_body[b] == tree) bodies.push_back(b);
  return bodies;
}

void list_pairs(const World& world, BodyPairRun& run) {
  if (run.listed) return;
  run.listed = true;
  const Joined joined = joined_bodies(world.model);
  const std::vector<int> of_b = bodies_of(world.topology, run.tree_b);
  for (const int a : bodies_of(world.topology, run.tree_a))
    for (const int b : of_b)
      if (can_meet_between(world.model, joined, a, b)) run.pairs.push_back({a, b});
}

}  // namespace

std::size_t count_pairs_between_bodies(const Model& model) {
  const Joined joined = joined_bodies(model);
  const int n = static_cast<int>(model.bodies.size());
  std::size_t count = 0;
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b) count += can_meet_between(model, joined, a, b);
  return count;
}

std::size_t count_pairs_held(const Model& model) {
  Joined joined = joined_bodies(model);
  joined.erase(std::unique(joined.begin(), joined.end()), joined.end());
  return static_cast<std::size_t>(std::count_if(joined.begin(), joined.end(), [&](const auto& pair) {
    const auto [a, b] = pair;
    return a >= 0 && !of_one_person(model, a, b) && are_rounds(model, a, b);
  }));
}

void add_pairs_within_persons(World& world, int effect) {
  // all of two trees together, so that one look at the trees does for all their pairs
  std::map<std::pair<int, int>, std::vector<BodyPair>> by_trees;
  for (const BodyPair& pair : pairs_within_persons(world.model))
    by_trees[{world.topology.tree_of_body[pair.a], world.topology.tree_of_body[pair.b]}].push_back(pair);
  for (const auto& [trees, pairs] : by_trees) world.pairs.round.push_back({effect, trees.first, trees.second, true, pairs});
}

void add_runs_between_bodies(World& world, int effect) {
  constexpr std::size_t kAtOnce = 140;  // bodies whose ten thousand pairs at most are listed before the first step: none waits then
  const bool at_once = world.model.bodies.size() <= kAtOnce;
  const Joined joined = joined_bodies(world.model);
  const int trees = static_cast<int>(world.topology.trees.size());
  std::vector<std::vector<int>> bodies;
  for (int tree = -1; tree < trees; ++tree) bodies.push_back(bodies_of(world.topology, tree));
  for (int tree_a = -1; tree_a < trees; ++tree_a)
    for (int tree_b = -1; tree_b < trees; ++tree_b) {
      const auto &of_a = bodies[static_cast<std::size_t>(tree_a + 1)], &of_b = bodies[static_cast<std::size_t>(tree_b + 1)];
      const bool any = std::any_of(of_a.begin(), of_a.end(), [&](int a) {
        return std::any_of(of_b.begin(), of_b.end(), [&](int b) { return can_meet_between(world.model, joined, a, b); });
      });
      if (!any) continue;
      world.pairs.round.push_back({effect, tree_a, tree_b, false, {}});
      if (at_once) list_pairs(world, world.pairs.round.back());
    }
}

void list_pairs(World& world, std::size_t run, std::vector<PairMemory>& memory) {
  list_pairs(world, world.pairs.round[run]);
  memory.resize(world.pairs.round[run].pairs.size());
}

void find_pair_contacts(ContactSearch& search, const PairKind& kind, int effect) {
  const ContactPairs& pairs = search.world.pairs;
  for (const std::size_t r : pairs.in_reach.round) {
    const BodyPairRun& run = pairs.round[r];
    if (run.effect != effect) continue;
    list_pairs(search.world, r, search.state.contact_memory.round[r]);
    for (std::size_t i = 0; i < run.pairs.size(); ++i) {
      const auto [a, b] = run.pairs[i];
      if (!pairs.broad_phase.apart(search.at, a, b)) add_contacts(search, kind, {a, b, i, r}, effect);
    }
  }
}

}  // namespace engine
