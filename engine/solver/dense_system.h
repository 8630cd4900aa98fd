// A dense system of some tens of unknowns, solved in place: no allocation once it has had its largest size.
#pragma once

#include <vector>

namespace engine {

class DenseSystem {
 public:
  void reserve(std::size_t n) { A_.reserve(n * n), b_.reserve(n); }
  void resize(int n);
  int size() const { return n_; }
  double& A(int row, int column) { return A_[static_cast<std::size_t>(column) * stride_ + static_cast<std::size_t>(row)]; }
  double& b(int row) { return b_[static_cast<std::size_t>(row)]; }

  /// Gaussian elimination with partial pivoting; b becomes the solution. False if a pivot vanishes.
  bool solve();

 private:
  int n_ = 0;
  std::size_t stride_ = 0;
  std::vector<double> A_;  // column-major
  std::vector<double> b_;
};

}  // namespace engine
