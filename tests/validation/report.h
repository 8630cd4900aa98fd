// What the validation prints, and how sure a mean of runs is.
#pragma once

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

namespace validation {

/// A line of the table; one that does not hold is counted.
void tell(const std::string& what, const std::string& asked, const std::string& seen, bool held);

/// Mean and the half width of its 95 % interval.
struct Mean {
  double value = std::nan(""), half = std::nan("");
  std::size_t count = 0;
};

/// By Student's t. Its quantile: G. W. Hill, Comm. ACM 13, 1970, two terms of the expansion about the normal one; off by less than
/// 0.5 % from ten values on.
inline Mean mean_of(const std::vector<double>& x) {
  const auto n = static_cast<double>(x.size());
  const double mean = std::accumulate(x.begin(), x.end(), 0.0) / n;
  double squares = 0;
  for (const double v : x) squares += (v - mean) * (v - mean);
  constexpr double z = 1.959964;
  const double nu = n - 1, z3 = z * z * z, z5 = z3 * z * z;
  const double t = z + (z3 + z) / (4 * nu) + (5 * z5 + 16 * z3 + 3 * z) / (96 * nu * nu);
  return {mean, t * std::sqrt(squares / nu / n), x.size()};
}

/// A published buck of three tubes.
void tube_buck();

}  // namespace validation
