#include "engine/step/islands.h"

#include <algorithm>
#include <utility>

namespace engine {
namespace {

/// Conditions of many trees in the order in which their trees lie beside each other (Cuthill and McKee 1969, on the trees), so that
/// what answers each other stands together and the matrices of the solver are bands.
void order_by_neighbours(StepContext& s, std::vector<int>& island) {
  const auto trees_of = [&](int i) {
    const Constraint& c = s.constraints[i];
    const auto tree = [&](int body) { return body < 0 ? -1 : s.world.topology.tree_of_body[body]; };
    const int a = tree(c.body_a), b = tree(c.body_b);
    return a < 0 ? std::pair(b, b) : b < 0 ? std::pair(a, a) : std::pair(a, b);
  };
  std::vector<int>&place = s.buffers.islands.place, &line = s.buffers.islands.line;
  place.assign(s.world.topology.trees.size(), -1);
  // from either end of the island: the tree reached last from any stands at its edge
  int start = trees_of(island.front()).first;
  for (int pass = 0; pass < 2; ++pass) {
    if (pass > 0) start = line.back(), std::fill(place.begin(), place.end(), -1);
    line.assign(1, start);
    place[start] = 0;
    for (std::size_t k = 0; k < line.size(); ++k)
      for (const int i : island) {
        const auto [a, b] = trees_of(i);
        const int next = a == line[k] ? b : b == line[k] ? a : line[k];
        if (place[next] >= 0) continue;
        place[next] = static_cast<int>(line.size());
        line.push_back(next);
      }
  }
  if (line.size() <= 2) return;
  std::sort(island.begin(), island.end(), [&](int i, int j) {
    const auto [ia, ib] = trees_of(i);
    const auto [ja, jb] = trees_of(j);
    const int at_i = place[ia] + place[ib], at_j = place[ja] + place[jb];
    return at_i != at_j ? at_i < at_j : i < j;
  });
}

}  // namespace

void build_islands(StepContext& s) {
  Islands& islands = s.buffers.islands;
  const int trees = static_cast<int>(s.world.topology.trees.size());
  islands.of_tree.resize(trees);
  for (int t = 0; t < trees; ++t) islands.of_tree[t] = t;
  auto find = [&](int t) {
    while (islands.of_tree[t] != t) t = islands.of_tree[t] = islands.of_tree[islands.of_tree[t]];
    return t;
  };
  auto tree_of = [&](int body) { return body < 0 ? -1 : s.world.topology.tree_of_body[body]; };
  for (const Constraint& c : s.constraints) {
    const int a = tree_of(c.body_a), b = tree_of(c.body_b);
    if (a < 0 || b < 0) continue;
    const int ra = find(a), rb = find(b);
    if (ra != rb) islands.of_tree[std::max(ra, rb)] = std::min(ra, rb);
  }
  for (auto& island : islands.members) island.clear();
  islands.members.resize(trees);
  for (int i = 0; i < static_cast<int>(s.constraints.size()); ++i) {
    const Constraint& c = s.constraints[i];
    islands.members[find(tree_of(c.body_a >= 0 ? c.body_a : c.body_b))].push_back(i);
  }
  for (auto& island : islands.members)
    if (!island.empty()) order_by_neighbours(s, island);
}

}  // namespace engine
