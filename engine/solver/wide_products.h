// The products that take most of a step with contacts, in wide vectors where the processor has them, with the same bits everywhere.
#pragma once

#include <array>
#include <cstddef>

namespace engine {

/// out = A in; A 6 x 6, `in` and `out` 6 x `columns`, all column-major, `out` apart from the others.
void multiply_by_six(const double* A, const double* in, double* out, std::size_t columns);

/// sum += G x; G `rows` x 3, column-major.
void add_three_columns(const double* G, const double* x, double* sum, std::size_t rows);

/// Three rows of six, column-major with a fourth, empty row.
using ThreeRows = std::array<double, 24>;

/// sum += J W^T; J 3 x 6, row-major, W 6 x 6, column-major.
void add_rows_through(const double* J, const double* W, ThreeRows& sum);

/// sum += Y J^T; J 3 x 6, row-major, sum 4 x 3, column-major, its last row empty.
void add_rows_met(const ThreeRows& Y, const double* J, std::array<double, 12>& sum);

}  // namespace engine
