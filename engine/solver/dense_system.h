// A dense system of some tens of unknowns, solved in place: no allocation once it has had its largest size. It is ours because
// Eigen's takes 2.1 times as long for 12 unknowns and 3.8 times for 48 (`benchmark_engine dense`, tests/benchmark/README.md): it
// keeps to the vectors of the plainest processor.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/math/aligned_vector.h"
#include "engine/solver/wide_products.h"

namespace engine {

/// Rows from `begin` to `end`, in whole fours.
struct RowRun {
  std::size_t begin, end;
};

class DenseSystem {
 public:
  void reserve(std::size_t n) {
    A_.reserve(whole_rows(n) * whole(n)), b_.reserve(whole(n)), diagonal_.reserve(whole(n)), pivot_.reserve(whole(n)),
        reach_.reserve(whole(n)), runs_.reserve(whole(n));
  }
  /// A and b are to be written whole.
  void resize(int n);
  int size() const { return static_cast<int>(n_); }
  double& A(int row, int column) { return A_[static_cast<std::size_t>(column) * stride_ + static_cast<std::size_t>(row)]; }
  double* column(int column) { return A_.data() + static_cast<std::size_t>(column) * stride_; }
  double& b(int row) { return b_[static_cast<std::size_t>(row)]; }

  /// Gaussian elimination with partial pivoting; A is used up. False if a pivot vanishes.
  bool factor();
  /// The same with the pivots where they stand, in three quarters of the time: of what is nearly symmetric and positive definite.
  /// False where one has lost nearly all that stood there first: A, used up too, is then to be written again for `factor`.
  bool factor_in_order();
  /// b becomes the solution; again for other b, as long as A is not touched.
  void solve();

 private:
  /// The system is filled up to a multiple of four unknowns.
  static std::size_t whole(std::size_t n) { return (n + 3) / 4 * 4; }

  std::size_t n_ = 0;
  std::size_t stride_ = 0;  // whole_rows(n_): columns begin on cache lines
  AlignedVector A_;         // column-major
  std::vector<double> b_;
  std::vector<double> diagonal_;    // as A was written
  std::vector<std::size_t> pivot_;  // row that changed places with row k
  std::vector<std::size_t> reach_;  // per four columns: past the last row that is not zero in them
  std::vector<RowRun> runs_;        // of the rows that the panel in hand has a part in
};

}  // namespace engine
