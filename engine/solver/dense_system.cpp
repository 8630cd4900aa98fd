#include "engine/solver/dense_system.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace engine {

void DenseSystem::resize(int n) {
  n_ = static_cast<std::size_t>(n);
  stride_ = stride_of(n_);
  if (A_.size() < stride_ * n_) A_.resize(stride_ * n_);  // never smaller: growing again would write zeros for nothing
  if (b_.size() < stride_) b_.resize(stride_);
  if (pivot_.size() < n_) pivot_.resize(n_);
  for (std::size_t c = 0; c < n_; ++c) std::fill(A_.data() + c * stride_ + n_, A_.data() + (c + 1) * stride_, 0.0);
  std::fill(b_.data() + n_, b_.data() + stride_, 0.0);
}

namespace {

constexpr std::size_t kPanel = 4;  // columns whose multiples are taken from the others in one pass over the memory

using Four = double __attribute__((vector_size(4 * sizeof(double))));
static_assert(kPanel * sizeof(double) == sizeof(Four));  // behind a panel begin whole vectors

/// Wide vectors where the processor has them; without fused multiply-add, so that all processors find the same bits.
#if defined(__x86_64__)
__attribute__((target_clones("avx2", "default")))
#endif
bool factor_in_place(double* A, std::size_t n, std::size_t stride, std::size_t* pivots) {
  for (std::size_t first = 0; first < n; first += kPanel) {
    const std::size_t end = std::min(first + kPanel, n);
    for (std::size_t k = first; k < end; ++k) {
      double* column = A + k * stride;
      for (std::size_t j = first; j < k; ++j) {
        const double* before = A + j * stride;
        const double factor = column[j];
        for (std::size_t i = j + 1; i < n; ++i) column[i] -= before[i] * factor;
      }
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < n; ++i)
        if (std::abs(column[i]) > std::abs(column[pivot])) pivot = i;
      if (!(std::abs(column[pivot]) > 1e-100)) return false;
      pivots[k] = pivot;
      if (pivot != k)
        for (std::size_t c = 0; c < n; ++c) std::swap(A[c * stride + k], A[c * stride + pivot]);
      const double inverse = 1 / column[k];
      for (std::size_t i = k + 1; i < n; ++i) column[i] *= inverse;
    }
    if (end - first < kPanel) break;  // nothing behind it
    const double *p0 = A + first * stride, *p1 = p0 + stride, *p2 = p1 + stride, *p3 = p2 + stride;
    for (std::size_t c = end; c < n; ++c) {
      double* column = A + c * stride;
      const double f0 = column[first];
      const double f1 = column[first + 1] -= p0[first + 1] * f0;
      const double f2 = column[first + 2] = column[first + 2] - p0[first + 2] * f0 - p1[first + 2] * f1;
      const double f3 = column[first + 3] = column[first + 3] - p0[first + 3] * f0 - p1[first + 3] * f1 - p2[first + 3] * f2;
      for (std::size_t i = end; i < n; i += 4) {
        Four sum, q0, q1, q2, q3;
        std::memcpy(&sum, column + i, sizeof sum);
        std::memcpy(&q0, p0 + i, sizeof q0);
        std::memcpy(&q1, p1 + i, sizeof q1);
        std::memcpy(&q2, p2 + i, sizeof q2);
        std::memcpy(&q3, p3 + i, sizeof q3);
        sum = sum - q0 * f0 - q1 * f1 - q2 * f2 - q3 * f3;
        std::memcpy(column + i, &sum, sizeof sum);
      }
    }
  }
  return true;
}

#if defined(__x86_64__)
__attribute__((target_clones("avx2", "default")))
#endif
void substitute(const double* A, std::size_t n, std::size_t stride, double* b) {
  for (std::size_t k = 0; k < n; ++k) {
    const double* column = A + k * stride;
    const double factor = b[k];
    for (std::size_t i = k + 1; i < n; ++i) b[i] -= column[i] * factor;
  }
  for (std::size_t k = n; k-- > 0;) {
    const double* column = A + k * stride;
    b[k] /= column[k];
    const double factor = b[k];
    for (std::size_t i = 0; i < k; ++i) b[i] -= column[i] * factor;
  }
}

}  // namespace

bool DenseSystem::factor() {
  return factor_in_place(A_.data(), n_, stride_, pivot_.data());
}

void DenseSystem::solve() {
  for (std::size_t k = 0; k < n_; ++k)
    if (pivot_[k] != k) std::swap(b_[k], b_[pivot_[k]]);
  substitute(A_.data(), n_, stride_, b_.data());
}

}  // namespace engine
