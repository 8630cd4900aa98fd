#include "engine/solver/dense_system.h"

#include <algorithm>
#include <cmath>

namespace engine {

void DenseSystem::resize(int n) {
  n_ = static_cast<std::size_t>(n);
  A_.assign(n_ * n_, 0.0);
  b_.assign(n_, 0.0);
  pivot_.resize(n_);
}

namespace {

constexpr std::size_t kPanel = 4;  // columns whose multiples are taken from the others in one pass over the memory

/// Wide vectors where the processor has them; without fused multiply-add, so that all processors find the same bits.
#if defined(__x86_64__)
__attribute__((target_clones("avx2", "default")))
#endif
bool factor_in_place(double* A, std::size_t n, std::size_t* pivots) {
  for (std::size_t first = 0; first < n; first += kPanel) {
    const std::size_t end = std::min(first + kPanel, n);
    for (std::size_t k = first; k < end; ++k) {
      double* column = A + k * n;
      for (std::size_t j = first; j < k; ++j) {
        const double* before = A + j * n;
        const double factor = column[j];
        for (std::size_t i = j + 1; i < n; ++i) column[i] -= before[i] * factor;
      }
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < n; ++i)
        if (std::abs(column[i]) > std::abs(column[pivot])) pivot = i;
      if (!(std::abs(column[pivot]) > 1e-100)) return false;
      pivots[k] = pivot;
      if (pivot != k)
        for (std::size_t c = 0; c < n; ++c) std::swap(A[c * n + k], A[c * n + pivot]);
      const double inverse = 1 / column[k];
      for (std::size_t i = k + 1; i < n; ++i) column[i] *= inverse;
    }
    if (end - first < kPanel) break;  // nothing behind it
    const double *p0 = A + first * n, *p1 = p0 + n, *p2 = p1 + n, *p3 = p2 + n;
    for (std::size_t c = end; c < n; ++c) {
      double* __restrict column = A + c * n;
      const double f0 = column[first];
      const double f1 = column[first + 1] -= p0[first + 1] * f0;
      const double f2 = column[first + 2] = column[first + 2] - p0[first + 2] * f0 - p1[first + 2] * f1;
      const double f3 = column[first + 3] = column[first + 3] - p0[first + 3] * f0 - p1[first + 3] * f1 - p2[first + 3] * f2;
      for (std::size_t i = end; i < n; ++i) column[i] = column[i] - p0[i] * f0 - p1[i] * f1 - p2[i] * f2 - p3[i] * f3;
    }
  }
  return true;
}

#if defined(__x86_64__)
__attribute__((target_clones("avx2", "default")))
#endif
void substitute(const double* A, std::size_t n, double* b) {
  for (std::size_t k = 0; k < n; ++k) {
    const double* column = A + k * n;
    const double factor = b[k];
    for (std::size_t i = k + 1; i < n; ++i) b[i] -= column[i] * factor;
  }
  for (std::size_t k = n; k-- > 0;) {
    const double* column = A + k * n;
    b[k] /= column[k];
    const double factor = b[k];
    for (std::size_t i = 0; i < k; ++i) b[i] -= column[i] * factor;
  }
}

}  // namespace

bool DenseSystem::factor() {
  return factor_in_place(A_.data(), n_, pivot_.data());
}

void DenseSystem::solve() {
  for (std::size_t k = 0; k < n_; ++k)
    if (pivot_[k] != k) std::swap(b_[k], b_[pivot_[k]]);
  substitute(A_.data(), n_, b_.data());
}

}  // namespace engine
