#include "assets/generate/curve.h"

namespace assets {

double through(const Curve& k, double x) {
  if (x <= k.front()[0]) return k.front()[1];
  if (x >= k.back()[0]) return k.back()[1];
  const std::size_t n = k.size();
  std::vector<double> slope(n, 0), chord(n - 1, 0);
  for (std::size_t i = 0; i + 1 < n; ++i) chord[i] = (k[i + 1][1] - k[i][1]) / (k[i + 1][0] - k[i][0]);
  slope[0] = chord[0];
  slope[n - 1] = chord[n - 2];
  for (std::size_t i = 1; i + 1 < n; ++i)
    slope[i] = chord[i - 1] * chord[i] <= 0 ? 0 : 2 * chord[i - 1] * chord[i] / (chord[i - 1] + chord[i]);
  std::size_t i = 0;
  while (x > k[i + 1][0]) ++i;
  const double h = k[i + 1][0] - k[i][0], s = (x - k[i][0]) / h;
  return (2 * s * s * s - 3 * s * s + 1) * k[i][1] + (s * s * s - 2 * s * s + s) * h * slope[i] +
         (-2 * s * s * s + 3 * s * s) * k[i + 1][1] + (s * s * s - s * s) * h * slope[i + 1];
}

}  // namespace assets
