// Order statistics of small samples: what an ensemble and repeated timings are told by.
#pragma once

#include <vector>

namespace cli::study {

/// Value below which `share` (0..1) of the sample lies, linear between its members; NaN for an empty sample.
double percentile(std::vector<double> sample, double share);
double median(const std::vector<double>& sample);

}  // namespace cli::study
