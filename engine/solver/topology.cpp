#include "engine/solver/topology.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace engine {
namespace {

/// Union-find over bodies; the smaller index represents.
class DisjointSets {
 public:
  explicit DisjointSets(int n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  bool unite(int a, int b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    parent_[std::max(a, b)] = std::min(a, b);
    return true;
  }

 private:
  std::vector<int> parent_;
};

struct Branch {
  int joint;
  int other;  // body at the far end
  bool other_is_child;
};

struct Forest {
  std::vector<std::vector<Branch>> branches;  // per body
  std::vector<int> world_joint;               // per body, -1: none
};

Forest plant(const Model& model, const std::vector<char>& broken, std::vector<int>& loops) {
  const int n = static_cast<int>(model.bodies.size());
  auto grounded = [&](int b) { return b < 0 || model.bodies[b].fixed; };
  Forest forest{std::vector<std::vector<Branch>>(n), std::vector<int>(n, -1)};
  DisjointSets sets(n + 1);  // slot n is the world
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    if (!broken.empty() && broken[j]) continue;
    if (std::isfinite(model.joints[j].breaking_force)) {
      loops.push_back(j);
      continue;
    }
    const int a = grounded(model.joints[j].parent) ? n : model.joints[j].parent;
    const int b = grounded(model.joints[j].child) ? n : model.joints[j].child;
    if (a == n && b == n) continue;
    if (!sets.unite(a, b)) {
      loops.push_back(j);
    } else if (a == n || b == n) {
      forest.world_joint[a == n ? b : a] = j;
    } else {
      forest.branches[a].push_back({j, b, true});
      forest.branches[b].push_back({j, a, false});
    }
  }
  return forest;
}

std::vector<Topology::Link> walk_from(int root, const Model& model, const Forest& forest, std::vector<char>& seen) {
  const int w = forest.world_joint[root];
  std::vector<Topology::Link> links{{root, -1, w, w < 0 || model.joints[w].child == root, 0}};
  seen[root] = 1;
  for (std::size_t at = 0; at < links.size(); ++at) {
    const int body = links[at].body;
    for (const Branch& branch : forest.branches[body]) {
      if (seen[branch.other]) continue;
      seen[branch.other] = 1;
      links.push_back({branch.other, body, branch.joint, branch.other_is_child, 0});
    }
  }
  std::reverse(links.begin(), links.end());
  return links;
}

}  // namespace

Topology build_topology(const Model& model, const std::vector<char>& broken) {
  const int n = static_cast<int>(model.bodies.size());
  Topology topology;
  topology.tree_of_body.assign(n, -1);
  topology.link_of_body.assign(n, -1);
  const Forest forest = plant(model, broken, topology.loops);

  // a tree that stands on the world is rooted there; every other at its first body
  std::vector<int> roots;
  for (int b = 0; b < n; ++b)
    if (forest.world_joint[b] >= 0) roots.push_back(b);
  for (int b = 0; b < n; ++b) roots.push_back(b);
  std::vector<std::vector<Topology::Link>> found;
  std::vector<char> seen(n, 0);
  for (const int root : roots)
    if (!seen[root] && !model.bodies[root].fixed) found.push_back(walk_from(root, model, forest, seen));

  auto first_body = [](const std::vector<Topology::Link>& links) {
    return std::min_element(links.begin(), links.end(), [](auto& x, auto& y) { return x.body < y.body; })->body;
  };
  std::sort(found.begin(), found.end(), [&](auto& x, auto& y) { return first_body(x) < first_body(y); });
  for (const auto& links : found) {
    Topology::Tree tree{static_cast<int>(topology.links.size()), 0, model.bodies[links.back().body].person};
    for (Topology::Link link : links) {
      link.tree = static_cast<int>(topology.trees.size());
      topology.tree_of_body[link.body] = link.tree;
      topology.link_of_body[link.body] = static_cast<int>(topology.links.size());
      topology.links.push_back(link);
    }
    tree.end = static_cast<int>(topology.links.size());
    topology.trees.push_back(tree);
  }
  return topology;
}

}  // namespace engine
