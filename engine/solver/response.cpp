#include "engine/solver/response.h"

#include <algorithm>

#include "engine/solver/wide_products.h"

namespace engine {

void Response::reset(const Topology& topology) {
  slot_of_body_.assign(topology.tree_of_body.size(), -1);
  marked_.assign(topology.trees.size(), {});
  base_.assign(topology.trees.size(), 0);
  trees_.clear();
  touched_.clear();
  std::size_t blocks = 0;
  for (std::size_t tree = 0; tree < topology.trees.size(); ++tree) {
    const auto bodies = static_cast<std::size_t>(topology.trees[tree].end - topology.trees[tree].begin);
    marked_[tree].reserve(bodies);
    blocks += bodies * bodies;
  }
  blocks_.reserve(blocks);
  trees_.reserve(topology.trees.size());
  touched_.reserve(topology.tree_of_body.size());
}

void Response::clear() {
  for (const int tree : trees_) {
    for (const int body : marked_[tree]) slot_of_body_[body] = -1;
    marked_[tree].clear();
  }
  trees_.clear();
  touched_.clear();
}

void Response::touch(const Topology& topology, int body) {
  if (std::find(touched_.begin(), touched_.end(), body) != touched_.end()) return;
  touched_.push_back(body);
  const int tree = topology.tree_of_body[body];
  if (marked_[tree].empty()) trees_.push_back(tree);
  for (int b = body; b >= 0 && slot_of_body_[b] < 0; b = topology.links[topology.link_of_body[b]].parent) {
    slot_of_body_[b] = 0;
    marked_[tree].push_back(b);
  }
}

void Response::compute(const Topology& topology, const Articulation& articulation) {
  std::size_t total = 0;
  for (const int tree : trees_) {
    base_[tree] = total;
    total += marked_[tree].size() * marked_[tree].size();
  }
  if (blocks_.size() < total) blocks_.resize(total);
  for (const int tree : trees_) {
    std::vector<int>& list = marked_[tree];
    // root first: links run leaves first
    std::sort(list.begin(), list.end(), [&](int x, int y) { return topology.link_of_body[x] > topology.link_of_body[y]; });
    const int n = static_cast<int>(list.size());
    Mat6* W = blocks_.data() + base_[tree];
    for (int i = 0; i < n; ++i) {
      slot_of_body_[list[i]] = i;
      const int link = topology.link_of_body[list[i]];
      const Articulation::Factor& f = articulation.of_link(link);
      const int parent = topology.links[link].parent;
      Mat6& own = W[i * n + i];
      own = f.D;
      if (parent < 0) {
        for (int j = 0; j < i; ++j) W[i * n + j].setZero(), W[j * n + i].setZero();
        continue;
      }
      const int p = slot_of_body_[parent];
      multiply_by_six(f.X.data(), W[p * n].data(), W[i * n].data(), static_cast<std::size_t>(6 * i));
      for (int j = 0; j < i; ++j) W[j * n + i] = W[i * n + j].transpose();
      own.noalias() += W[i * n + p] * f.X.transpose();
    }
  }
}

const Mat6& Response::between(const Topology& topology, int i, int j) const {
  const int tree = topology.tree_of_body[i];
  const std::size_t n = marked_[tree].size();
  return blocks_[base_[tree] + static_cast<std::size_t>(slot_of_body_[i]) * n + static_cast<std::size_t>(slot_of_body_[j])];
}

}  // namespace engine
