#include "engine/solver/response.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace engine {
namespace {

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

/// The freedoms on the ways of two bodies (-1: none). Links ascend towards the root.
void Response::meet(const Topology& topology, int body_a, int body_b) {
  constexpr int kNone = std::numeric_limits<int>::max();
  const auto link_of = [&](int body) { return body >= 0 ? topology.link_of_body[body] : kNone; };
  met_.clear();
  for (int a = link_of(body_a), b = link_of(body_b); std::min(a, b) != kNone;) {
    const int link = std::min(a, b), above = link_of(topology.links[link].parent);
    for (int k = 0; k < rank_[link]; ++k) met_.push_back(first_[link] + k);
    if (a == link) a = above;
    if (b == link) b = above;
  }
}

void Response::compute(const Topology& topology, const Articulation& articulation, const std::vector<Constraint>& all,
                       const std::vector<int>& members, const std::vector<int>& offset, std::size_t stride,
                       std::vector<double>& G) {
  for (const int m : members)
    for (const int body : {all[m].body_a, all[m].body_b}) mark(topology, body);
  std::sort(marked_.begin(), marked_.end());
  int freedoms = 0;
  for (const int link : marked_) {
    const Articulation::Factor& f = articulation.of_link(link);
    rank_[link] = 6 - f.rows.count;
    first_[link] = freedoms;
    freedoms += rank_[link];
    take_root(f.D, rank_[link], Q_[link]);
  }

  Y_.assign(static_cast<std::size_t>(freedoms) * stride + 4, 0.0);  // the last row is written as a whole vector too
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Constraint& c = all[members[i]];
    const auto row = static_cast<std::size_t>(offset[i]);
    for (const auto& [body, J] : {std::pair{c.body_a, c.J_a.data()}, std::pair{c.body_b, c.J_b.data()}}) {
      if (body < 0) continue;
      follow(topology, articulation, body);
      carry_up(J, way_.data(), way_.size(), Y_.data() + row, stride);
    }
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Constraint& c = all[members[i]];
    meet(topology, c.body_a, c.body_b);
    meet_rows(Y_.data(), stride, met_.data(), met_.size(), static_cast<std::size_t>(offset[i]), static_cast<std::size_t>(c.rows),
              G.data());
  }
  for (const int link : marked_) first_[link] = -1;
  marked_.clear();
}

}  // namespace engine
