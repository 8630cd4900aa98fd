// In which order the conditions of an island are eliminated: which it is, and that it keeps zeros.
#include "engine/solver/elimination_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace engine {
namespace {

/// Trees of one body each, and conditions of three rows between two of them or, with -1, between one and the world.
struct Island {
  Topology topology;
  std::vector<Constraint> all;
  std::vector<int> members;

  explicit Island(int trees) {
    for (int t = 0; t < trees; ++t) {
      topology.trees.push_back({t, t + 1, -1});
      topology.tree_of_body.push_back(t);
    }
  }
  void add(int a, int b) {
    Constraint c;
    c.a.body = a, c.b.body = b;
    members.push_back(static_cast<int>(all.size()));
    all.push_back(c);
  }
  bool answer(int i, int j) const {
    for (const int a : {all[i].a.body, all[i].b.body})
      for (const int b : {all[j].a.body, all[j].b.body})
        if (a >= 0 && a == b) return true;
    return false;
  }
  /// Pairs of conditions between which there is a number once they are eliminated in this order.
  int filled(const std::vector<int>& order) const {
    const std::size_t n = order.size();
    std::vector<std::vector<char>> any(n, std::vector<char>(n));
    for (std::size_t r = 0; r < n; ++r)
      for (std::size_t c = 0; c < n; ++c) any[r][c] = answer(order[r], order[c]);
    int count = 0;
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t r = k + 1; r < n; ++r) {
        if (!any[r][k]) continue;
        ++count;
        for (std::size_t c = k + 1; c < n; ++c) any[r][c] = any[r][c] || any[k][c];
      }
    return count;
  }
  std::vector<int> elimination_order() const {
    EliminationOrder out;
    out.find(topology, all, members);
    return out.order();
  }
  std::vector<int> as_they_stand() const {
    std::vector<int> order(members.size());
    std::iota(order.begin(), order.end(), 0);
    return order;
  }
};

TEST(EliminationOrder, LeavesOneTreeAndTwoAsTheyStand) {
  Island island(2);
  for (const auto& [a, b] : {std::pair(1, -1), std::pair(0, 1), std::pair(-1, 0), std::pair(0, 0), std::pair(1, 0)})
    island.add(a, b);
  EXPECT_EQ(island.elimination_order(), island.as_they_stand());
}

// Newton leaves zeros out by these bits: none may be missing, whatever the number of trees, and of up to 64 none is too many.
TEST(EliminationOrder, HasACommonBitWhereTwoAnswerEachOther) {
  for (const int trees : {64, 100}) {
    Island island(trees);
    for (int t = 0; t < trees; ++t) {
      island.add(t, -1);
      island.add((7 * t + 3) % trees, t);
    }
    EliminationOrder order;
    order.find(island.topology, island.all, island.members);
    for (int i = 0; i < 2 * trees; ++i)
      for (int j = 0; j < 2 * trees; ++j) {
        const bool common = (order.trees(i) & order.trees(j)) != 0;
        EXPECT_TRUE(common || !island.answer(i, j)) << i << " " << j;
        EXPECT_TRUE(!common || island.answer(i, j) || trees > 64) << i << " " << j;
      }
  }
}

TEST(EliminationOrder, AddsNoNumberWhereNoneIsNeeded) {
  // a chain and a star of persons, written down from the middle: an order that fills nothing exists, theirs fills much
  for (const bool star : {false, true}) {
    constexpr int kTrees = 12;
    Island island(kTrees);
    for (int k = 0; k < kTrees / 2; ++k)
      for (const int t : {kTrees / 2 - 1 - k, kTrees / 2 + k}) {
        if (t > 0) island.add(star ? 0 : t - 1, t);
        island.add(t, -1);
        island.add(t, t);
      }
    int numbers = 0;
    for (std::size_t i = 0; i < island.all.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) numbers += island.answer(static_cast<int>(i), static_cast<int>(j));
    const std::vector<int> found = island.elimination_order();
    EXPECT_EQ(island.filled(found), numbers) << (star ? "star" : "chain");
    EXPECT_GT(island.filled(island.as_they_stand()), numbers) << "or there is nothing to gain";
    std::vector<int> sorted = found;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, island.as_they_stand());
  }
}

TEST(EliminationOrder, FillsHeapsLessThanTheOrderOfTheirPersons) {
  // persons thrown on a square, who meet all within reach; each lies on the ground and on itself
  constexpr int kTrees = 16, kHeaps = 20;
  constexpr double kReach = 0.35;
  std::srand(23);
  int filled = 0, as_they_stand = 0;
  for (int heap = 0; heap < kHeaps; ++heap) {
    const Eigen::MatrixXd at = Eigen::MatrixXd::Random(2, kTrees);
    Island island(kTrees);
    for (int t = 0; t < kTrees; ++t) {
      island.add(t, -1);
      island.add(t, t);
      for (int other = 0; other < t; ++other)
        if ((at.col(t) - at.col(other)).norm() < 2 * kReach) island.add(other, t);
    }
    filled += island.filled(island.elimination_order());
    as_they_stand += island.filled(island.as_they_stand());
  }
  EXPECT_LT(filled, 0.9 * as_they_stand);  // 0.84
}

}  // namespace
}  // namespace engine
