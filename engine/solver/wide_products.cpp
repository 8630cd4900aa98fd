#include "engine/solver/wide_products.h"

#include <cstring>

namespace engine {
namespace {

using Four = double __attribute__((vector_size(4 * sizeof(double))));
using Two = double __attribute__((vector_size(2 * sizeof(double))));

}  // namespace

#if defined(__x86_64__)
__attribute__((target_clones("avx2", "default")))
#endif
void multiply_by_six(const double* A, const double* in, double* out, std::size_t columns) {
  Four upper[6];
  Two lower[6];
  for (int k = 0; k < 6; ++k) {
    std::memcpy(&upper[k], A + 6 * k, sizeof(Four));
    std::memcpy(&lower[k], A + 6 * k + 4, sizeof(Two));
  }
  for (std::size_t c = 0; c < columns; ++c, in += 6, out += 6) {
    Four u = upper[0] * in[0];
    Two l = lower[0] * in[0];
    for (int k = 1; k < 6; ++k) {
      u += upper[k] * in[k];
      l += lower[k] * in[k];
    }
    std::memcpy(out, &u, sizeof(Four));
    std::memcpy(out + 4, &l, sizeof(Two));
  }
}

#if defined(__x86_64__)
__attribute__((target_clones("avx2", "default")))
#endif
void add_three_columns(const double* G, const double* x, double* sum, std::size_t rows) {
  const double *G0 = G, *G1 = G + rows, *G2 = G1 + rows;
  const double x0 = x[0], x1 = x[1], x2 = x[2];
  for (std::size_t r = 0; r < rows; ++r) sum[r] = sum[r] + G0[r] * x0 + G1[r] * x1 + G2[r] * x2;
}

#if defined(__x86_64__)
__attribute__((target_clones("avx2", "default")))
#endif
void add_rows_through(const double* J, const double* W, ThreeRows& sum) {
  Four column[6];
  for (int k = 0; k < 6; ++k) column[k] = Four{J[k], J[6 + k], J[12 + k], 0};
  for (int t = 0; t < 6; ++t) {
    Four part = column[0] * W[t];
    for (int k = 1; k < 6; ++k) part += column[k] * W[6 * k + t];
    Four total;
    std::memcpy(&total, &sum[4 * t], sizeof total);
    total += part;
    std::memcpy(&sum[4 * t], &total, sizeof total);
  }
}

#if defined(__x86_64__)
__attribute__((target_clones("avx2", "default")))
#endif
void add_rows_met(const ThreeRows& Y, const double* J, std::array<double, 12>& sum) {
  Four column[6];
  std::memcpy(column, Y.data(), sizeof column);
  for (int q = 0; q < 3; ++q) {
    const double* row = J + 6 * q;
    const Four even = column[0] * row[0] + (column[2] * row[2] + column[4] * row[4]);
    const Four odd = column[1] * row[1] + (column[3] * row[3] + column[5] * row[5]);
    Four total;
    std::memcpy(&total, &sum[4 * q], sizeof total);
    total += even + odd;
    std::memcpy(&sum[4 * q], &total, sizeof total);
  }
}

}  // namespace engine
