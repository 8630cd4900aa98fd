// The runs of a fit: a plan from the prior, then where the evidence is explained.
#pragma once

#include "cli/inference/ensemble.h"
#include "cli/inference/fit.h"
#include "cli/inference/prior.h"

namespace cli::inference {

struct SearchWish {
  int runs = 2000;  // at most; the first half from the prior, so that it serves as a sample as well
  std::uint64_t seed = 1;
};

struct Search {
  Table table;
  std::vector<double> log_ratios;
  std::size_t from_prior = 0;  // the first rows
};

/// Stops early when a third of the runs allowed are effective. The same seed gives the same runs, whatever the number of processes.
Search search(const scenes::Scene&, const Prior&, Ensemble&, const SearchWish&);

}  // namespace cli::inference
