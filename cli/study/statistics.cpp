#include "cli/study/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cli::study {

double percentile(std::vector<double> sample, double share) {
  if (sample.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(sample.begin(), sample.end());
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(sample.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sample.size() - 1);
  return sample[below] + (place - static_cast<double>(below)) * (sample[above] - sample[below]);
}

double median(const std::vector<double>& sample) {
  return percentile(sample, 0.5);
}

}  // namespace cli::study
