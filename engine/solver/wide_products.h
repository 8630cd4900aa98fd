// The products that take most of a step with contacts, in wide vectors where the processor has them, with the same bits everywhere.
#pragma once

#include <cstddef>

namespace engine {

/// Rows filled up to whole vectors, two at a time.
inline std::size_t whole_rows(std::size_t rows) {
  return (rows + 7) / 8 * 8;
}

struct Rows {
  std::size_t begin = 0, end = 0;
};

/// sum += G x; G `rows` x 3, a column every `stride` numbers.
void add_three_columns(const double* G, std::size_t stride, const double* x, double* sum, std::size_t rows);

/// A link that a force passes on its way to the root: what it becomes is X^T of it, and Q^T of it works the link's freedoms, whose
/// places are from `first` on. X and Q 6 x 6, column-major; X null: the root.
struct Passed {
  const double* X;
  const double* Q;
  int freedoms;
  std::size_t first;
};

/// Carries the three rows of J (3 x 6, row-major) up a way: Y[place * stride + r] += what row r does to the freedom of that place.
/// Adds a zero to Y[place * stride + 3].
void carry_up(const double* J, const Passed* way, std::size_t links, double* Y, std::size_t stride);

/// Of G = Y^T Y, `stride` x `stride`, the rows named (whole_rows both) in the `columns` (1 to 3) from `row` on: summed over the
/// freedoms listed, all others being zero there.
void meet_rows(const double* Y, std::size_t stride, const int* freedoms, std::size_t count, Rows, std::size_t row,
               std::size_t columns, double* G);

}  // namespace engine
