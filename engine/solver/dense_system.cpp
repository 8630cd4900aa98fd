#include "engine/solver/dense_system.h"

#include <algorithm>
#include <cmath>

namespace engine {

void DenseSystem::resize(int n) {
  n_ = n;
  stride_ = static_cast<std::size_t>(n);
  A_.assign(stride_ * stride_, 0.0);
  b_.assign(stride_, 0.0);
}

bool DenseSystem::solve() {
  const std::size_t n = stride_;
  for (std::size_t k = 0; k < n; ++k) {
    double* pivot_column = A_.data() + k * stride_;
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(pivot_column[i]) > std::abs(pivot_column[pivot])) pivot = i;
    if (!(std::abs(pivot_column[pivot]) > 1e-100)) return false;
    if (pivot != k) {
      for (std::size_t c = 0; c < n; ++c) std::swap(A_[c * stride_ + k], A_[c * stride_ + pivot]);
      std::swap(b_[k], b_[pivot]);
    }
    const double inverse = 1 / pivot_column[k];
    for (std::size_t i = k + 1; i < n; ++i) pivot_column[i] *= inverse;
    for (std::size_t c = k + 1; c < n; ++c) {
      double* column = A_.data() + c * stride_;
      const double factor = column[k];
      if (factor == 0) continue;
      for (std::size_t i = k + 1; i < n; ++i) column[i] -= pivot_column[i] * factor;
    }
    const double factor = b_[k];
    for (std::size_t i = k + 1; i < n; ++i) b_[i] -= pivot_column[i] * factor;
  }
  for (std::size_t k = n; k-- > 0;) {
    const double* column = A_.data() + k * stride_;
    b_[k] /= column[k];
    for (std::size_t i = 0; i < k; ++i) b_[i] -= column[i] * b_[k];
  }
  return true;
}

}  // namespace engine
