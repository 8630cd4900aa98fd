#include "engine/solver/response.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace engine {
namespace {

constexpr Rows kNoRows{std::numeric_limits<std::size_t>::max(), 0};

/// Columns of Q with Q Q^T = D, of the rank given (Cholesky, the largest pivot first).
void take_root(Mat6 D, int rank, Mat6& Q) {
  for (int k = 0; k < rank; ++k) {
    Eigen::Index pivot = 0;
    const double largest = D.diagonal().maxCoeff(&pivot);
    if (largest <= 0) {
      Q.col(k).setZero();
      continue;
    }
    Q.col(k) = D.col(pivot) / std::sqrt(largest);
    D.noalias() -= Q.col(k) * Q.col(k).transpose();
  }
}

}  // namespace

void Response::reset(const Topology& topology, std::size_t constraints) {
  const std::size_t links = topology.links.size();
  first_.assign(links, -1);
  rank_.resize(links);
  Q_.resize(links);
  marked_.clear();
  marked_.reserve(links);
  way_.reserve(links);
  met_.reserve(6 * links);
  reach_.reserve(constraints);
  rows_.assign(topology.trees.size(), kNoRows);
  Y_.reserve(std::min<std::size_t>(6 * links, 128) * whole_rows(3 * constraints) + 4);
}

/// The links from a body up to its root.
void Response::mark(const Topology& topology, int body) {
  for (int b = body; b >= 0; b = topology.links[topology.link_of_body[b]].parent) {
    const int link = topology.link_of_body[b];
    if (first_[link] >= 0) return;
    first_[link] = 0;
    marked_.push_back(link);
  }
}

/// The way of a force on a body up to its root.
void Response::follow(const Topology& topology, const Articulation& articulation, int body) {
  way_.clear();
  for (int b = body; b >= 0;) {
    const int link = topology.link_of_body[b];
    b = topology.links[link].parent;
    way_.push_back({b >= 0 ? articulation.of_link(link).X.data() : nullptr, Q_[link].data(), rank_[link],
                    static_cast<std::size_t>(first_[link])});
  }
}

/// The freedoms on the ways of two bodies (-1: none); returns how many are of the first tree among theirs. Links ascend towards the
/// root, and from tree to tree.
std::size_t Response::meet(const Topology& topology, int body_a, int body_b) {
  constexpr int kNone = std::numeric_limits<int>::max();
  const auto link_of = [&](int body) { return body >= 0 ? topology.link_of_body[body] : kNone; };
  met_.clear();
  int a = link_of(body_a), b = link_of(body_b);
  const int tree = topology.links[std::min(a, b)].tree;
  std::size_t of_first = 0;
  while (std::min(a, b) != kNone) {
    const int link = std::min(a, b), above = link_of(topology.links[link].parent);
    for (int k = 0; k < rank_[link]; ++k) met_.push_back(first_[link] + k);
    if (topology.links[link].tree == tree) of_first = met_.size();
    if (a == link) a = above;
    if (b == link) b = above;
  }
  return of_first;
}

void Response::note_rows(int tree, std::size_t first, std::size_t last) {
  Rows& rows = rows_[tree];
  rows = {std::min(rows.begin, first / 8 * 8), std::max(rows.end, whole_rows(last))};
}

/// The columns of a constraint: rows of its first tree, of its second, of both.
Rows Response::write_columns(const Topology& topology, const Constraint& c, std::size_t row, std::size_t stride, double* G) {
  const std::size_t of_first = meet(topology, c.a.body, c.b.body), of_both = met_.size();
  int first = c.a.body >= 0 ? topology.tree_of_body[c.a.body] : -1, second = c.b.body >= 0 ? topology.tree_of_body[c.b.body] : -1;
  if (first < 0 || (second >= 0 && second < first)) std::swap(first, second);
  const Rows a = rows_[first], b = second >= 0 && second != first ? rows_[second] : a;
  const Rows reach{std::min(a.begin, b.begin), std::max(a.end, b.end)};
  const auto within = [](const Rows& rows, std::size_t r) { return rows.begin <= r && r < rows.end; };
  // the same freedoms in the same order gave the columns before this one their rows here
  const std::size_t fresh = row / 8 * 8;
  for (std::size_t r = reach.begin; r < fresh; ++r)
    for (std::size_t k = row; k < row + static_cast<std::size_t>(c.rows); ++k) G[k * stride + r] = G[r * stride + k];
  for (std::size_t r = std::max(reach.begin, fresh), next = 0; r < reach.end; r = next) {
    next = reach.end;
    for (const std::size_t edge : {a.begin, a.end, b.begin, b.end})
      if (edge > r) next = std::min(next, edge);
    const std::size_t from = within(a, r) ? 0 : of_first, to = within(b, r) ? of_both : of_first;
    meet_rows(Y_.data(), stride, met_.data() + from, to - from, {r, next}, row, static_cast<std::size_t>(c.rows), G);
  }
  for (std::size_t k = row; k < row + static_cast<std::size_t>(c.rows); ++k) {
    std::fill(G + k * stride, G + k * stride + reach.begin, 0.0);
    std::fill(G + k * stride + reach.end, G + (k + 1) * stride, 0.0);
  }
  return reach;
}

void Response::compute(const Topology& topology, const Articulation& articulation, const std::vector<Constraint>& all,
                       const std::vector<int>& members, const std::vector<int>& offset, std::size_t stride, AlignedVector& G,
                       const Changed* since) {
  const auto is_new = [since](int tree) { return !since || since->trees[static_cast<std::size_t>(tree)] != 0; };
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Constraint& c = all[members[i]];
    const auto row = static_cast<std::size_t>(offset[i]);
    for (const int body : {c.a.body, c.b.body}) {
      if (body < 0) continue;
      mark(topology, body);
      note_rows(topology.tree_of_body[body], row, row + static_cast<std::size_t>(c.rows));
    }
  }
  std::sort(marked_.begin(), marked_.end());
  int freedoms = 0;
  for (const int link : marked_) {
    const Articulation::Factor& f = articulation.of_link(link);
    rank_[link] = 6 - f.rows.count;
    first_[link] = freedoms;
    freedoms += rank_[link];
    if (is_new(topology.links[link].tree)) take_root(f.D, rank_[link], Q_[link]);
  }

  // the last row is written as a whole vector too; never smaller: growing again would write zeros for nothing
  if (const std::size_t room = static_cast<std::size_t>(freedoms) * stride + 4; Y_.size() < room) Y_.resize(room);
  for (const int link : marked_) {
    if (!is_new(topology.links[link].tree)) continue;
    const Rows rows = rows_[topology.links[link].tree];
    for (int k = first_[link]; k < first_[link] + rank_[link]; ++k) {
      double* y = Y_.data() + static_cast<std::size_t>(k) * stride;
      std::fill(y + rows.begin, y + rows.end, 0.0);
    }
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Constraint& c = all[members[i]];
    const auto row = static_cast<std::size_t>(offset[i]);
    for (const auto& [body, J] : {std::pair{c.a.body, c.a.J.data()}, std::pair{c.b.body, c.b.J.data()}}) {
      if (body < 0 || !is_new(topology.tree_of_body[body])) continue;
      follow(topology, articulation, body);
      carry_up(J, way_.data(), way_.size(), Y_.data() + row, stride);
    }
  }
  reach_.resize(members.size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Constraint& c = all[members[i]];
    const auto meets_new = [&](int body) { return body >= 0 && is_new(topology.tree_of_body[body]); };
    if (meets_new(c.a.body) || meets_new(c.b.body) || (since && since->diagonals[i] != 0))
      reach_[i] = write_columns(topology, c, static_cast<std::size_t>(offset[i]), stride, G.data());
  }
  for (const int link : marked_) {
    first_[link] = -1;
    rows_[topology.links[link].tree] = kNoRows;
  }
  marked_.clear();
}

}  // namespace engine
