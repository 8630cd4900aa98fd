// Minimum degree (Tinney and Walker 1967) on pairs of trees. Conditions answer each other that share a tree. Once those between two
// trees are eliminated, the two are as one to the rest. So next come always those of the pair that the fewest rows act on.
#include "engine/solver/elimination_order.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/math/disjoint_sets.h"

namespace engine {

void EliminationOrder::reserve(std::size_t trees, std::size_t constraints) {
  for (auto* list : {&order_, &turn_}) list->reserve(constraints);
  for (auto* list : {&one_, &rows_}) list->reserve(trees);
  trees_.reserve(constraints);
  pairs_.reserve(constraints);
}

/// The first that does not stand before it.
std::vector<EliminationOrder::Pair>::iterator EliminationOrder::pair_of(const std::pair<int, int>& trees) {
  return std::lower_bound(pairs_.begin(), pairs_.end(), trees,
                          [](const Pair& pair, const std::pair<int, int>& other) { return pair.trees < other; });
}

void EliminationOrder::find_pairs(const Topology& topology, const std::vector<Constraint>& all, const std::vector<int>& members) {
  trees_.clear();
  pairs_.clear();
  for (const int m : members) {
    const auto tree_of = [&](int body) { return body < 0 ? -1 : topology.tree_of_body[body]; };
    const int a = tree_of(all[m].a.body), b = tree_of(all[m].b.body);
    trees_.push_back(std::minmax(a < 0 ? b : a, b < 0 ? a : b));
    const auto at = pair_of(trees_.back());
    if (at != pairs_.end() && at->trees == trees_.back()) {
      at->rows += all[m].rows;
    } else {
      pairs_.insert(at, {trees_.back(), all[m].rows, -1});
    }
  }
}

bool EliminationOrder::joins_three_trees() const {
  const int one = pairs_.front().trees.first;
  int other = one;
  for (const Pair& pair : pairs_)
    for (const int tree : {pair.trees.first, pair.trees.second}) {
      if (tree == one || tree == other) continue;
      if (other != one) return true;
      other = tree;
    }
  return false;
}

/// What stands for its trees, the smaller first.
std::pair<int, int> EliminationOrder::ones(const Pair& pair) {
  return std::minmax({math::representative(one_, pair.trees.first), math::representative(one_, pair.trees.second)});
}

void EliminationOrder::count(const Pair& pair, int sign) {
  const auto [a, b] = ones(pair);
  rows_[static_cast<std::size_t>(a)] += sign * pair.rows;
  if (b != a) rows_[static_cast<std::size_t>(b)] += sign * pair.rows;
}

void EliminationOrder::give_turns() {
  const auto rows = [this](int tree) -> int& { return rows_[static_cast<std::size_t>(tree)]; };
  for (const Pair& pair : pairs_) count(pair, 1);
  for (int turn = 0; turn < static_cast<int>(pairs_.size()); ++turn) {
    Pair* next = nullptr;
    int fewest = std::numeric_limits<int>::max();
    for (Pair& pair : pairs_) {
      if (pair.turn >= 0) continue;
      const auto [a, b] = ones(pair);
      const int acting = a == b ? rows(a) : rows(a) + rows(b) - pair.rows;
      if (acting < fewest) fewest = acting, next = &pair;
    }
    next->turn = turn;
    count(*next, -1);
    const auto [a, b] = ones(*next);
    if (a == b) continue;
    for (const Pair& pair : pairs_)  // those between the two were counted for both
      if (pair.turn < 0 && ones(pair) == std::pair(a, b)) rows(b) -= pair.rows;
    rows(a) += rows(b);
    one_[static_cast<std::size_t>(b)] = a;
  }
}

void EliminationOrder::find(const Topology& topology, const std::vector<Constraint>& all, const std::vector<int>& members) {
  order_.resize(members.size());
  std::iota(order_.begin(), order_.end(), 0);
  find_pairs(topology, all, members);
  if (!joins_three_trees()) return;
  one_.resize(topology.trees.size());
  std::iota(one_.begin(), one_.end(), 0);
  rows_.assign(one_.size(), 0);
  give_turns();
  turn_.clear();
  for (const std::pair<int, int>& trees : trees_) turn_.push_back(pair_of(trees)->turn);
  std::sort(order_.begin(), order_.end(), [this](int i, int j) {
    return std::pair(turn_[static_cast<std::size_t>(i)], i) < std::pair(turn_[static_cast<std::size_t>(j)], j);
  });
}

}  // namespace engine
