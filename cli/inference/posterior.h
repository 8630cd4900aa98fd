// What the evidence makes of the prior: weighted runs, and what may be said of them.
#pragma once

#include <string>
#include <vector>

#include "cli/inference/prior.h"

namespace cli::inference {

/// Runs with weights that sum to one, or all zero where none explains anything.
struct Weighted {
  std::vector<double> weights;
  double effective = 0;  // effective number of runs: (sum w)^2 / sum w^2
};

/// From logarithms of weights; minus infinity is a weight of zero.
Weighted normalised(const std::vector<double>& log_weights);

double mean_of(const std::vector<double>& values, const std::vector<double>& weights);
double sd_of(const std::vector<double>& values, const std::vector<double>& weights);
/// Value below which `share` of the weight lies, linear between the runs' middles.
double quantile_of(const std::vector<double>& values, const std::vector<double>& weights, double share);

/// A hill of the density that holds at least a tenth of the weight.
struct Mode {
  double low = 0, high = 0;  // the middle 95 % of it
  double peak = 0;
  double share = 0;  // of the weight
};

/// A density over `points` places by a kernel of the width that suits the effective number of runs.
struct Density {
  std::vector<double> x, y;
};
Density density_of(const std::vector<double>& values, const Weighted&, double low, double high, int points);

/// Hills with a valley between them that is lower than half of the lower one.
std::vector<Mode> modes_of(const std::vector<double>& values, const Weighted&);

/// Whether the weight piles up at an end of what the prior holds possible: the outer twentieth of the prior (`shares` 0..1) holds
/// more than three times its part, and more than any other twentieth. -1 low end, 1 high end, 0 neither.
int piled_at_end(const std::vector<double>& shares, const std::vector<double>& weights);

double correlation_of(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& weights);

}  // namespace cli::inference
