#include "engine/step/islands.h"

#include <algorithm>
#include <utility>

#include "engine/math/disjoint_sets.h"

namespace engine {
namespace {

/// Conditions of many trees in the order in which their trees lie beside each other (Cuthill and McKee 1969, on the trees), so that
/// what answers each other stands together and the matrices of the solver are bands.
void order_by_neighbours(StepContext& s, std::vector<int>& island) {
  const std::vector<std::pair<int, int>>& ends = s.buffers.islands.ends;
  std::vector<int>&place = s.buffers.islands.place, &line = s.buffers.islands.line;
  place.assign(s.world.topology.trees.size(), -1);
  // from either end of the island: the tree reached last from any stands at its edge
  int start = ends[island.front()].first;
  for (int pass = 0; pass < 2; ++pass) {
    if (pass > 0) start = line.back(), std::fill(place.begin(), place.end(), -1);
    line.assign(1, start);
    place[start] = 0;
    for (std::size_t k = 0; k < line.size(); ++k)
      for (const int i : island) {
        const auto [a, b] = ends[i];
        const int next = a == line[k] ? b : b == line[k] ? a : line[k];
        if (place[next] >= 0) continue;
        place[next] = static_cast<int>(line.size());
        line.push_back(next);
      }
  }
  if (line.size() <= 2) return;
  std::sort(island.begin(), island.end(), [&](int i, int j) {
    const auto [ia, ib] = ends[i];
    const auto [ja, jb] = ends[j];
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
  const auto tree_of = [&](int body) { return body < 0 ? -1 : s.world.topology.tree_of_body[body]; };
  islands.ends.clear();
  for (const Constraint& c : s.constraints) {
    const int a = tree_of(c.a.body), b = tree_of(c.b.body);
    islands.ends.emplace_back(a < 0 ? b : a, b < 0 ? a : b);
  }
  for (const auto& [a, b] : islands.ends) {
    const int ra = math::representative(islands.of_tree, a), rb = math::representative(islands.of_tree, b);
    if (ra != rb) islands.of_tree[std::max(ra, rb)] = std::min(ra, rb);
  }
  for (const int root : islands.roots) islands.members[root].clear();
  islands.roots.clear();
  for (std::size_t i = 0; i < islands.ends.size(); ++i) {
    const int root = math::representative(islands.of_tree, islands.ends[i].first);
    if (islands.members[root].empty()) islands.roots.push_back(root);
    islands.members[root].push_back(static_cast<int>(i));
  }
  // the largest last: what the solver knows of it serves a second pass
  std::sort(islands.roots.begin(), islands.roots.end(), [&](int a, int b) {
    const std::size_t of_a = islands.members[a].size(), of_b = islands.members[b].size();
    return of_a != of_b ? of_a < of_b : a < b;
  });
  for (const int root : islands.roots) order_by_neighbours(s, islands.members[root]);
}

}  // namespace engine
