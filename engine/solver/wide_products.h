// The products that take most of a step with contacts, in wide vectors where the processor has them, with the same bits everywhere.
#pragma once

#include <cstddef>

namespace engine {

/// out = A in; A 6 x 6, `in` and `out` 6 x `columns`, all column-major, `out` apart from the others.
void multiply_by_six(const double* A, const double* in, double* out, std::size_t columns);

/// sum += G x; G `rows` x 3, column-major.
void add_three_columns(const double* G, const double* x, double* sum, std::size_t rows);

}  // namespace engine
