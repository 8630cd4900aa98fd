#include "render/cost.h"

#include <ctime>
#include <numeric>

namespace render {

void add(const FrameCost& cost, FrameCost& sum) {
  for (std::size_t i = 0; i < kPasses; ++i) sum[i] += cost[i];
}

double together(const FrameCost& cost) {
  return std::accumulate(cost.begin(), cost.end(), 0.0);
}

double processor_ms() {
  return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void Stopwatch::lap(Pass pass) {
  const double now = processor_ms();
  (*cost_)[static_cast<std::size_t>(pass)] += now - since_;
  since_ = now;
}

}  // namespace render
