// Which inputs a measure hangs on: shares of its variance, from any sample of runs.
#pragma once

#include <string>
#include <vector>

#include "cli/inference/prior.h"

namespace cli::inference {

struct Share {
  double value = 0, low = 0, high = 0;  // with its 90 % range
};

/// Of one measure. `first` is the share of the variance that would go if the input were known; `total` what would be left if all
/// others were. `scatter` is what no smooth law of the inputs explains: chaos of the outcome, jumps, and waves too fine for the
/// law.
struct Sensitivity {
  std::vector<Share> first, total;  // by input
  Share scatter;
  int degree = 0;
  std::size_t runs = 0;  // it rests on
};

/// A polynomial in the inputs' shares, orthonormal under the prior, of the degree that predicts left-out runs best; its
/// coefficients' squares are the shares (Sudret 2008). Ranges by 50 samples with replacement. `shares` (runs x inputs) are the
/// independent ones, so that of correlated inputs each stands for what it adds to those before it. Nothing comes back (runs = 0)
/// where there are fewer than 20 runs with the measure or where it does not vary.
Sensitivity sensitivity(const std::vector<scenes::Uncertain>& inputs, const std::vector<std::vector<double>>& shares,
                        const std::vector<double>& output, std::uint64_t seed);

}  // namespace cli::inference
