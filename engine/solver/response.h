// How the rows of an island's conditions answer each other's impulses through the joints: G = J W J^T.
//
// W, the inverse of the factorised system, is a sum over the freedoms that joints and roots leave: at each link a force gives way
// by its D, and the X of the links below carry that motion on to a body (articulation.h). D has no more rank than the link has
// freedoms, D = Q Q^T, so G = Y^T Y with a row of Y for each freedom: the rows of J carried up from their bodies to the root as
// forces are, and at each link asked by Q^T how they work its freedoms. A contact meets only the freedoms on its own way, no block
// of W is ever formed, and G is symmetric and no eigenvalue of it negative but for rounding. Contacts that share no tree do not
// meet at all: of each tree the rows from its first to its last are looked at, few where members stand in the order of their trees.
#pragma once

#include <vector>

#include "engine/solver/articulation.h"
#include "engine/solver/constraint.h"
#include "engine/solver/wide_products.h"

namespace engine {

class Response {
 public:
  /// What is not as it was when G was written.
  struct Changed {
    const std::vector<char>& trees;        // not 0: factorised since
    const std::vector<double>& diagonals;  // per member, not 0: its diagonal was changed
  };

  /// Buffers for the links there are and so many constraints.
  void reset(const Topology&, std::size_t constraints);

  /// Writes G [1/kg] of the constraints named: `size` columns, each of `stride` rows (whole_rows(size)); the rows of constraint
  /// members[i] begin at offset[i]. Beyond `size` they are zero. With `since` G is the last one, of the same constraints, and
  /// only what has changed is written.
  void compute(const Topology&, const Articulation&, const std::vector<Constraint>&, const std::vector<int>& members,
               const std::vector<int>& offset, std::size_t stride, AlignedVector& G, const Changed* since = nullptr);

  /// Of the last G: outside of these rows the columns of members[i] are zero.
  Rows reach(std::size_t i) const { return reach_[i]; }

 private:
  void mark(const Topology&, int body);
  void follow(const Topology&, const Articulation&, int body);
  std::size_t meet(const Topology&, int body_a, int body_b);
  void note_rows(int tree, std::size_t first, std::size_t last);
  Rows write_columns(const Topology&, const Constraint&, std::size_t row, std::size_t stride, double* G);

  std::vector<int> first_;   // per link: its first freedom in Y, -1: not marked
  std::vector<int> marked_;  // links that stand on some row's way to the root, ascending
  std::vector<int> rank_;    // per link: its freedoms
  std::vector<Mat6> Q_;      // per link: as many columns as freedoms
  std::vector<Passed> way_;  // of one body to its root
  std::vector<int> met_;     // freedoms on the ways of one constraint's bodies, ascending
  std::vector<Rows> rows_;   // per tree: of G, whole vectors about all that it has a part in
  AlignedVector Y_;          // freedoms x stride
  std::vector<Rows> reach_;  // per constraint
};

}  // namespace engine
