#include "engine/step/islands.h"

#include <algorithm>

namespace engine {

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
}

}  // namespace engine
