#include "engine/solver/wide_products.h"

#include <cstring>

#include "engine/math/wide_clones.h"

namespace engine {
namespace {

using Four = double __attribute__((vector_size(4 * sizeof(double))));
using Eight = double __attribute__((vector_size(8 * sizeof(double))));

}  // namespace

CRASHREEL_WIDE_CLONES
void add_three_columns(const double* G, std::size_t stride, const double* x, double* sum, std::size_t rows) {
  const double *G0 = G, *G1 = G + stride, *G2 = G1 + stride;
  const double x0 = x[0], x1 = x[1], x2 = x[2];
  for (std::size_t r = 0; r < rows; ++r) sum[r] = sum[r] + G0[r] * x0 + G1[r] * x1 + G2[r] * x2;
}

CRASHREEL_WIDE_CLONES
void carry_up(const double* J, const Passed* way, std::size_t links, double* Y, std::size_t stride) {
  Four force[6];
  for (int t = 0; t < 6; ++t) force[t] = Four{J[t], J[6 + t], J[12 + t], 0};
  for (const Passed* link = way; link != way + links; ++link) {
    for (int k = 0; k < link->freedoms; ++k) {
      const double* q = link->Q + 6 * k;
      Four work = force[0] * q[0];
      for (int t = 1; t < 6; ++t) work += force[t] * q[t];
      double* at = Y + (link->first + static_cast<std::size_t>(k)) * stride;
      Four sum;
      std::memcpy(&sum, at, sizeof sum);
      sum += work;
      std::memcpy(at, &sum, sizeof sum);
    }
    if (!link->X) return;
    Four passed[6];
    for (int t = 0; t < 6; ++t) {
      const double* x = link->X + 6 * t;
      passed[t] = force[0] * x[0];
      for (int k = 1; k < 6; ++k) passed[t] += force[k] * x[k];
    }
    std::memcpy(force, passed, sizeof force);
  }
}

namespace {

/// So many vectors of rows from `r` on, of all columns at once: a column too many costs less than asking.
template <std::size_t kVectors>
inline __attribute__((always_inline)) void meet_some(const double* Y, std::size_t stride, const int* freedoms, std::size_t count,
                                                     std::size_t r, std::size_t row, std::size_t columns, double* G) {
  Eight g[3][kVectors] = {};
  for (std::size_t k = 0; k < count; ++k) {
    const double* y = Y + static_cast<std::size_t>(freedoms[k]) * stride;
    for (std::size_t v = 0; v < kVectors; ++v) {
      Eight some;
      std::memcpy(&some, y + r + 8 * v, sizeof some);
      for (std::size_t c = 0; c < 3; ++c) g[c][v] += some * y[row + c];
    }
  }
  for (std::size_t c = 0; c < columns; ++c) std::memcpy(G + (row + c) * stride + r, g[c], sizeof g[c]);
}

}  // namespace

CRASHREEL_WIDE_CLONES
void meet_rows(const double* Y, std::size_t stride, const int* freedoms, std::size_t count, Rows rows, std::size_t row,
               std::size_t columns, double* G) {
  std::size_t r = rows.begin;
  for (; r + 16 <= rows.end; r += 16) meet_some<2>(Y, stride, freedoms, count, r, row, columns, G);
  if (r < rows.end) meet_some<1>(Y, stride, freedoms, count, r, row, columns, G);
}

}  // namespace engine
