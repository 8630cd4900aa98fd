#include "engine/solver/dense_system.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "engine/math/wide_clones.h"

namespace engine {

void DenseSystem::resize(int n) {
  n_ = static_cast<std::size_t>(n);
  stride_ = whole_rows(n_);
  if (A_.size() < stride_ * stride_) A_.resize(stride_ * stride_);  // never smaller: growing again would write zeros for nothing
  if (b_.size() < stride_) b_.resize(stride_);
  if (diagonal_.size() < stride_) diagonal_.resize(stride_);
  if (pivot_.size() < stride_) pivot_.resize(stride_);
  if (reach_.size() < stride_) reach_.resize(stride_);
  if (runs_.size() < stride_) runs_.resize(stride_);
  for (std::size_t c = 0; c < n_; ++c) std::fill(A_.data() + c * stride_ + n_, A_.data() + (c + 1) * stride_, 0.0);
  std::fill(b_.data() + n_, b_.data() + stride_, 0.0);
  // unknowns nothing depends on, so that all panels are whole
  for (std::size_t c = n_; c < whole(n_); ++c) {
    std::fill(A_.data() + c * stride_, A_.data() + (c + 1) * stride_, 0.0);
    A_[c * stride_ + c] = 1;
  }
}

namespace {

// Columns go in panels of four: their multiples are taken from the others in one pass over the memory. A panel exchanges rows in
// itself and behind itself, not before itself; the solution follows by exchanging panel by panel too.
constexpr std::size_t kPanel = 4;

using Four = double __attribute__((vector_size(kPanel * sizeof(double))));
using Eight = double __attribute__((vector_size(2 * kPanel * sizeof(double))));
using Places = std::int64_t __attribute__((vector_size(kPanel * sizeof(double))));

constexpr Places kLane = {0, 1, 2, 3};
constexpr Places kNoSign = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX};
constexpr Places kBelow[] = {{0, -1, -1, -1}, {0, 0, -1, -1}, {0, 0, 0, -1}};  // of a panel's rows, those below the pivot

/// What is called from a function of two variants would be compiled for the plainest of them, unless it becomes a part of it.
#define PART_OF_BOTH inline __attribute__((always_inline))

struct Runs {
  const RowRun *begin, *end;
};

struct Panel {
  double *p0, *p1, *p2, *p3;  // its columns
  std::size_t first, end;     // its rows, which are those of its columns
};

// no constructor: clang++ leaves one of those out that a function of two variants calls
PART_OF_BOTH Panel panel_at(double* A, std::size_t stride, std::size_t at) {
  double* p0 = A + at * stride;
  return {p0, p0 + stride, p0 + 2 * stride, p0 + 3 * stride, at, at + kPanel};
}

/// A large system is mostly zeros. Rows behind a panel in which its columns are zero are left alone, and so are columns its rows
/// have no part in; a pivot that is nearly the largest stays where it is, for an exchange of rows fills what was zero.
constexpr std::size_t kLarge = 96;
constexpr double kNearlyLargest = 0.1;

/// Where all pivots stay, none may be less of what stood there first. Of a symmetric positive definite matrix that had a share
/// added to its diagonal no pivot is less than that share.
constexpr double kLeastPivot = 1e-4;  // [-]

/// Where the rows behind a panel are that it has a part in. Of a system that is not large, all of them up to the last.
PART_OF_BOTH Runs rows_behind(const Panel& panel, std::size_t n, RowRun* runs) {
  const auto is_zero = [&](std::size_t at) __attribute__((always_inline)) {
    Places b0, b1, b2, b3;
    std::memcpy(&b0, panel.p0 + at, sizeof b0);
    std::memcpy(&b1, panel.p1 + at, sizeof b1);
    std::memcpy(&b2, panel.p2 + at, sizeof b2);
    std::memcpy(&b3, panel.p3 + at, sizeof b3);
    const Places any = (b0 | b1 | b2 | b3) & kNoSign;
    return (any[0] | any[1] | any[2] | any[3]) == 0;
  };
  std::size_t last = n;
  while (last > panel.end && is_zero(last - kPanel)) last -= kPanel;
  RowRun* end = runs;
  *end++ = {panel.end, last};
  if (n < kLarge) return {runs, end};
  for (std::size_t at = panel.end; at < last; at += kPanel) {
    if (!is_zero(at)) continue;
    end[-1].end = at;
    while (is_zero(at + kPanel)) at += kPanel;
    *end++ = {at + kPanel, last};
  }
  return {runs, end};
}

struct Largest {
  double size;
  std::int64_t row;
};

/// Takes the multiples of the panel's columns before this one from it, and finds the first of its largest numbers below.
PART_OF_BOTH Largest reduce(const Panel& panel, double* column, std::int64_t step, const Runs& runs) {
  const auto [p0, p1, p2, p3, first, end] = panel;
  // of the columns from this one on nothing
  Places m0, m1, m2;
  Four h;
  std::memcpy(&m0, p0 + first, sizeof m0);
  std::memcpy(&m1, p1 + first, sizeof m1);
  std::memcpy(&m2, p2 + first, sizeof m2);
  std::memcpy(&h, column + first, sizeof h);
  const double f0 = step > 0 ? h[0] : 0;
  h = h - reinterpret_cast<Four>(m0 & kBelow[0]) * f0;
  const double f1 = step > 1 ? h[1] : 0;
  h = h - reinterpret_cast<Four>(m1 & kBelow[1]) * f1;
  const double f2 = step > 2 ? h[2] : 0;
  h = h - reinterpret_cast<Four>(m2 & kBelow[2]) * f2;
  std::memcpy(column + first, &h, sizeof h);
  // lane by lane
  Four largest = kLane < step ? Four{-1, -1, -1, -1} : reinterpret_cast<Four>(reinterpret_cast<Places>(h) & kNoSign);
  Places place = kLane + static_cast<std::int64_t>(first);
  for (const RowRun* run = runs.begin; run != runs.end; ++run)
    for (std::size_t i = run->begin; i < run->end; i += kPanel) {
      Four x, q0, q1, q2;
      std::memcpy(&x, column + i, sizeof x);
      std::memcpy(&q0, p0 + i, sizeof q0);
      std::memcpy(&q1, p1 + i, sizeof q1);
      std::memcpy(&q2, p2 + i, sizeof q2);
      x = x - q0 * f0 - q1 * f1 - q2 * f2;
      std::memcpy(column + i, &x, sizeof x);
      const Four size = reinterpret_cast<Four>(reinterpret_cast<Places>(x) & kNoSign);
      const Places here = kLane + static_cast<std::int64_t>(i);
      const auto larger = size > largest;
      largest = larger ? size : largest;
      place = larger ? here : place;
    }
  Largest out{largest[0], place[0]};
  for (int lane = 1; lane < 4; ++lane)
    if (largest[lane] > out.size || (largest[lane] == out.size && place[lane] < out.row)) out = {largest[lane], place[lane]};
  return out;
}

/// Makes the column below its pivot the multiples of the pivot's row.
PART_OF_BOTH void divide(const Panel& panel, double* column, std::int64_t step, const Runs& runs, double pivot) {
  const double inverse = 1 / pivot;
  Four h;
  std::memcpy(&h, column + panel.first, sizeof h);
  h = kLane > step ? h * inverse : h;
  std::memcpy(column + panel.first, &h, sizeof h);
  for (const RowRun* run = runs.begin; run != runs.end; ++run)
    for (std::size_t i = run->begin; i < run->end; i += kPanel) {
      Four x;
      std::memcpy(&x, column + i, sizeof x);
      x *= inverse;
      std::memcpy(column + i, &x, sizeof x);
    }
  column[panel.first + static_cast<std::size_t>(step)] = inverse;  // nobody asks for the pivot itself any more
}

/// Takes the panel's multiples from rows of two columns, as many as a vector has lanes.
template <class Vector>
PART_OF_BOTH void take_from_two(const Panel& panel, double* x, double* y, std::size_t at, const double (&f)[kPanel],
                                const double (&g)[kPanel]) {
  Vector u, v, q0, q1, q2, q3;
  std::memcpy(&u, x + at, sizeof u);
  std::memcpy(&v, y + at, sizeof v);
  std::memcpy(&q0, panel.p0 + at, sizeof q0);
  std::memcpy(&q1, panel.p1 + at, sizeof q1);
  std::memcpy(&q2, panel.p2 + at, sizeof q2);
  std::memcpy(&q3, panel.p3 + at, sizeof q3);
  u = u - q0 * f[0] - q1 * f[1] - q2 * f[2] - q3 * f[3];
  v = v - q0 * g[0] - q1 * g[1] - q2 * g[2] - q3 * g[3];
  std::memcpy(x + at, &u, sizeof u);
  std::memcpy(y + at, &v, sizeof v);
}

/// Takes the panel's multiples from the columns behind it, two at a time.
PART_OF_BOTH void take_from_columns_behind(const Panel& panel, double* A, std::size_t n, std::size_t stride, const Runs& runs) {
  const auto [p0, p1, p2, p3, first, end] = panel;
  Places m0, m1, m2;
  std::memcpy(&m0, p0 + first, sizeof m0);
  std::memcpy(&m1, p1 + first, sizeof m1);
  std::memcpy(&m2, p2 + first, sizeof m2);
  const Four L0 = reinterpret_cast<Four>(m0 & kBelow[0]);
  const Four L1 = reinterpret_cast<Four>(m1 & kBelow[1]);
  const Four L2 = reinterpret_cast<Four>(m2 & kBelow[2]);
  for (std::size_t c = end; c < n; c += 2) {
    double *x = A + c * stride, *y = x + stride;
    Four u, v;
    std::memcpy(&u, x + first, sizeof u);
    std::memcpy(&v, y + first, sizeof v);
    if (n >= kLarge) {
      const Places met = (reinterpret_cast<Places>(u) | reinterpret_cast<Places>(v)) & kNoSign;
      if ((met[0] | met[1] | met[2] | met[3]) == 0) continue;
    }
    const Four f0 = __builtin_shufflevector(u, u, 0, 0, 0, 0), g0 = __builtin_shufflevector(v, v, 0, 0, 0, 0);
    u = u - L0 * f0, v = v - L0 * g0;
    const Four f1 = __builtin_shufflevector(u, u, 1, 1, 1, 1), g1 = __builtin_shufflevector(v, v, 1, 1, 1, 1);
    u = u - L1 * f1, v = v - L1 * g1;
    const Four f2 = __builtin_shufflevector(u, u, 2, 2, 2, 2), g2 = __builtin_shufflevector(v, v, 2, 2, 2, 2);
    u = u - L2 * f2, v = v - L2 * g2;
    const Four f3 = __builtin_shufflevector(u, u, 3, 3, 3, 3), g3 = __builtin_shufflevector(v, v, 3, 3, 3, 3);
    std::memcpy(x + first, &u, sizeof u);
    std::memcpy(y + first, &v, sizeof v);
    const double f[] = {f0[0], f1[0], f2[0], f3[0]}, g[] = {g0[0], g1[0], g2[0], g3[0]};
    for (const RowRun* run = runs.begin; run != runs.end; ++run) {
      std::size_t i = run->begin;
      for (; i + 2 * kPanel <= run->end; i += 2 * kPanel) take_from_two<Eight>(panel, x, y, i, f, g);
      if (i < run->end) take_from_two<Four>(panel, x, y, i, f, g);
    }
  }
}

/// Wide vectors where the processor has them; without fused multiply-add, so that all processors find the same bits.
CRASHREEL_WIDE_CLONES
bool factor_in_place(double* A, std::size_t n, std::size_t stride, std::size_t* pivots, std::size_t* reach, RowRun* rows) {
  const double* past = A + n * stride;
  for (std::size_t first = 0; first < n; first += kPanel) {
    const Panel panel = panel_at(A, stride, first);
    const Runs runs = rows_behind(panel, n, rows);
    reach[first / kPanel] = runs.end[-1].end;
    for (std::size_t k = first; k < panel.end; ++k) {
      double* column = A + k * stride;
      const auto step = static_cast<std::int64_t>(k - first);
      const Largest largest = reduce(panel, column, step, runs);
      if (!(largest.size > 1e-100)) return false;
      const bool stays = n >= kLarge && std::abs(column[k]) >= kNearlyLargest * largest.size;
      const std::size_t pivot = stays ? k : static_cast<std::size_t>(largest.row);
      pivots[k] = pivot;
      // here and not where they are read next: a vector read right after one of its numbers is written waits for it
      if (pivot != k)
        for (double* c = panel.p0; c < past; c += stride) std::swap(c[k], c[pivot]);
      divide(panel, column, step, runs, column[k]);
    }
    take_from_columns_behind(panel, A, n, stride, runs);
  }
  return true;
}

/// What a panel's rows are divided by: the inverse pivots, and what stands to their right.
struct Divisor {
  double i0, i1, i2, i3, u01, u02, u03, u12, u13, u23;
};

/// Makes rows of the panel multiples of its pivots' rows, as many as a vector has lanes.
template <class Vector>
PART_OF_BOTH void divide_rows(const Panel& panel, std::size_t at, const Divisor& by) {
  Vector a0, a1, a2, a3;
  std::memcpy(&a0, panel.p0 + at, sizeof a0);
  std::memcpy(&a1, panel.p1 + at, sizeof a1);
  std::memcpy(&a2, panel.p2 + at, sizeof a2);
  std::memcpy(&a3, panel.p3 + at, sizeof a3);
  a0 = a0 * by.i0;
  a1 = (a1 - a0 * by.u01) * by.i1;
  a2 = (a2 - a0 * by.u02 - a1 * by.u12) * by.i2;
  a3 = (a3 - a0 * by.u03 - a1 * by.u13 - a2 * by.u23) * by.i3;
  std::memcpy(panel.p0 + at, &a0, sizeof a0);
  std::memcpy(panel.p1 + at, &a1, sizeof a1);
  std::memcpy(panel.p2 + at, &a2, sizeof a2);
  std::memcpy(panel.p3 + at, &a3, sizeof a3);
}

/// Eliminates in a panel with its pivots where they stand; false if one is small beside what stood there first, `diagonal`.
PART_OF_BOTH bool reduce_in_order(const Panel& panel, const double* diagonal, const Runs& runs) {
  const auto [p0, p1, p2, p3, first, end] = panel;
  Four c0, c1, c2, c3;
  std::memcpy(&c0, p0 + first, sizeof c0);
  std::memcpy(&c1, p1 + first, sizeof c1);
  std::memcpy(&c2, p2 + first, sizeof c2);
  std::memcpy(&c3, p3 + first, sizeof c3);
  Divisor by;
  by.i0 = 1 / c0[0];
  const Four L0 = reinterpret_cast<Four>(reinterpret_cast<Places>(c0 * by.i0) & kBelow[0]);
  by.u01 = c1[0], by.u02 = c2[0], by.u03 = c3[0];
  c1 = c1 - L0 * by.u01, c2 = c2 - L0 * by.u02, c3 = c3 - L0 * by.u03;
  by.i1 = 1 / c1[1];
  const Four L1 = reinterpret_cast<Four>(reinterpret_cast<Places>(c1 * by.i1) & kBelow[1]);
  by.u12 = c2[1], by.u13 = c3[1];
  c2 = c2 - L1 * by.u12, c3 = c3 - L1 * by.u13;
  by.i2 = 1 / c2[2];
  const Four L2 = reinterpret_cast<Four>(reinterpret_cast<Places>(c2 * by.i2) & kBelow[2]);
  by.u23 = c3[2];
  c3 = c3 - L2 * by.u23;
  by.i3 = 1 / c3[3];
  const bool large = c0[0] > kLeastPivot * diagonal[0] && c1[1] > kLeastPivot * diagonal[1] && c2[2] > kLeastPivot * diagonal[2] &&
                     c3[3] > kLeastPivot * diagonal[3];
  if (!large) return false;
  c0 = Four{by.i0, L0[1], L0[2], L0[3]};
  c1 = Four{by.u01, by.i1, L1[2], L1[3]};
  c2 = Four{by.u02, by.u12, by.i2, L2[3]};
  c3 = Four{by.u03, by.u13, by.u23, by.i3};
  std::memcpy(p0 + first, &c0, sizeof c0);
  std::memcpy(p1 + first, &c1, sizeof c1);
  std::memcpy(p2 + first, &c2, sizeof c2);
  std::memcpy(p3 + first, &c3, sizeof c3);
  for (const RowRun* run = runs.begin; run != runs.end; ++run) {
    std::size_t i = run->begin;
    for (; i + 2 * kPanel <= run->end; i += 2 * kPanel) divide_rows<Eight>(panel, i, by);
    if (i < run->end) divide_rows<Four>(panel, i, by);
  }
  return true;
}

CRASHREEL_WIDE_CLONES
bool factor_in_order(double* A, std::size_t n, std::size_t stride, double* diagonal, std::size_t* reach, RowRun* rows) {
  for (std::size_t k = 0; k < n; ++k) diagonal[k] = A[k * (stride + 1)];
  for (std::size_t first = 0; first < n; first += kPanel) {
    const Panel panel = panel_at(A, stride, first);
    const Runs runs = rows_behind(panel, n, rows);
    reach[first / kPanel] = runs.end[-1].end;
    if (!reduce_in_order(panel, diagonal + first, runs)) return false;
    take_from_columns_behind(panel, A, n, stride, runs);
  }
  return true;
}

/// Takes four columns by their factors from x[begin] to x[end - 1], the first of them first.
PART_OF_BOTH void take_from(double* x, std::size_t begin, std::size_t end, const double* const (&columns)[kPanel],
                            const double (&factors)[kPanel]) {
  for (std::size_t i = begin; i < end; i += kPanel) {
    Four sum, q0, q1, q2, q3;
    std::memcpy(&sum, x + i, sizeof sum);
    std::memcpy(&q0, columns[0] + i, sizeof q0);
    std::memcpy(&q1, columns[1] + i, sizeof q1);
    std::memcpy(&q2, columns[2] + i, sizeof q2);
    std::memcpy(&q3, columns[3] + i, sizeof q3);
    sum = sum - q0 * factors[0] - q1 * factors[1] - q2 * factors[2] - q3 * factors[3];
    std::memcpy(x + i, &sum, sizeof sum);
  }
}

CRASHREEL_WIDE_CLONES
void substitute(const double* A, std::size_t n, std::size_t stride, const std::size_t* pivots, const std::size_t* reach,
                double* b) {
  for (std::size_t first = 0; first < n; first += kPanel) {
    const double *p0 = A + first * stride, *p1 = p0 + stride, *p2 = p1 + stride, *p3 = p2 + stride;
    for (std::size_t k = first; k < first + kPanel; ++k) std::swap(b[k], b[pivots[k]]);
    const double f0 = b[first];
    const double f1 = b[first + 1] -= p0[first + 1] * f0;
    const double f2 = b[first + 2] = b[first + 2] - p0[first + 2] * f0 - p1[first + 2] * f1;
    const double f3 = b[first + 3] = b[first + 3] - p0[first + 3] * f0 - p1[first + 3] * f1 - p2[first + 3] * f2;
    take_from(b, first + kPanel, reach[first / kPanel], {p0, p1, p2, p3}, {f0, f1, f2, f3});
  }
  for (std::size_t first = n; first > 0;) {
    first -= kPanel;
    const double *p0 = A + first * stride, *p1 = p0 + stride, *p2 = p1 + stride, *p3 = p2 + stride;
    double* x = b + first;
    const double f3 = x[3] = x[3] * p3[first + 3];
    const double f2 = x[2] = (x[2] - p3[first + 2] * f3) * p2[first + 2];
    const double f1 = x[1] = (x[1] - p3[first + 1] * f3 - p2[first + 1] * f2) * p1[first + 1];
    const double f0 = x[0] = (x[0] - p3[first] * f3 - p2[first] * f2 - p1[first] * f1) * p0[first];
    take_from(b, 0, first, {p3, p2, p1, p0}, {f3, f2, f1, f0});
  }
}

}  // namespace

bool DenseSystem::factor_in_order() {
  for (std::size_t k = 0; k < stride_; ++k) pivot_[k] = k;
  return engine::factor_in_order(A_.data(), whole(n_), stride_, diagonal_.data(), reach_.data(), runs_.data());
}

bool DenseSystem::factor() {
  return factor_in_place(A_.data(), whole(n_), stride_, pivot_.data(), reach_.data(), runs_.data());
}

void DenseSystem::solve() {
  substitute(A_.data(), whole(n_), stride_, pivot_.data(), reach_.data(), b_.data());
}

}  // namespace engine
