// In which order the conditions of an island are eliminated, so that what is zero stays zero.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/solver/constraint.h"
#include "engine/solver/topology.h"

namespace engine {

class EliminationOrder {
 public:
  void reserve(std::size_t trees, std::size_t constraints);

  /// Of one tree or two, whose matrix has no zeros, members keep their order.
  void find(const Topology& topology, const std::vector<Constraint>& all, const std::vector<int>& members);
  /// Positions in `members`, first to last.
  const std::vector<int>& order() const { return order_; }

  /// A bit for each tree of a member, the same for trees 64 apart: members without a common bit do not answer each other.
  std::uint64_t trees(int member) const {
    const auto [a, b] = trees_[static_cast<std::size_t>(member)];
    return std::uint64_t{1} << (a % 64) | std::uint64_t{1} << (b % 64);
  }

 private:
  /// Trees that there are conditions between, or twice the same where they hold one.
  struct Pair {
    std::pair<int, int> trees;
    int rows;  // of its conditions
    int turn;  // -1: not yet
  };

  std::vector<Pair>::iterator pair_of(const std::pair<int, int>& trees);
  void find_pairs(const Topology& topology, const std::vector<Constraint>& all, const std::vector<int>& members);
  bool joins_three_trees() const;
  void give_turns();
  std::pair<int, int> ones(const Pair& pair);
  void count(const Pair& pair, int sign);

  std::vector<int> order_;
  std::vector<std::pair<int, int>> trees_;  // per member
  std::vector<Pair> pairs_;                 // in order
  std::vector<int> turn_;                   // per member
  std::vector<int> one_;                    // per tree: one of those it has become one with
  std::vector<int> rows_;                   // per tree that stands for others: rows left that act on them
};

}  // namespace engine
