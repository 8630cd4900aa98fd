// With y_i = y0 + C h_i^p the differences of neighbours fall as h^p too: p is the slope of their logarithms over log h. Three
// levels always give a slope, whatever they mean: that is how a single triple understates errors a hundredfold. Hence four levels,
// and orders of neighbouring triples that agree.
#include "cli/study/convergence.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace cli::study {
namespace {

constexpr double kRounding = 1e-13;    // of the value: what a thousand rounded steps may add up to
constexpr double kLowestOrder = 0.4;   // below it the limit is farther away than any level has come
constexpr double kHighestOrder = 6.0;  // above it two answers agree by chance
constexpr double kOrderSpread = 0.15;  // times 1 + order, between neighbouring triples: orders within it count as one
constexpr std::size_t kFewestLevels = 4;

struct FittedOrder {
  double order = 0, limit = 0;
  double slope = 0;  // part of the finest level that still falls: C h^p there
};

/// Least squares on the logarithms: log|y_i - y_i+1| = const + p log h_i.
FittedOrder fit_order(const std::vector<Level>& levels, std::size_t first, std::size_t last) {
  double x_mean = 0, y_mean = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(last - first);
  const auto x_of = [&](std::size_t i) { return std::log(levels[i].step); };
  const auto y_of = [&](std::size_t i) { return std::log(std::abs(levels[i].value - levels[i + 1].value)); };
  for (std::size_t i = first; i < last; ++i) {
    x_mean += x_of(i) / n;
    y_mean += y_of(i) / n;
  }
  for (std::size_t i = first; i < last; ++i) {
    xx += (x_of(i) - x_mean) * (x_of(i) - x_mean);
    xy += (x_of(i) - x_mean) * (y_of(i) - y_mean);
  }
  const double order = xy / xx;
  // the finest two levels are nearest to the limit: they say how far it is
  const double ratio = std::pow(levels[last - 1].step / levels[last].step, order);
  const double slope = (levels[last - 1].value - levels[last].value) / (ratio - 1);
  return {order, levels[last].value - slope, slope};
}

/// Orders of the neighbouring triples of a window agree and lie where an order can lie.
bool steady(const std::vector<Level>& levels, std::size_t first, std::size_t last) {
  double lowest = kHighestOrder, highest = kLowestOrder;
  for (std::size_t i = first; i + 2 <= last; ++i) {
    const double coarse = levels[i].value - levels[i + 1].value;
    const double fine = levels[i + 1].value - levels[i + 2].value;
    if (!(coarse * fine > 0)) return false;
    const double order = std::log(coarse / fine) / std::log(levels[i].step / levels[i + 1].step);
    lowest = std::min(lowest, order);
    highest = std::max(highest, order);
    if (order < kLowestOrder || order > kHighestOrder) return false;
  }
  return highest - lowest < kOrderSpread * (1 + lowest);
}

double range_of(const std::vector<Level>& levels, std::size_t first) {
  double low = levels[first].value, high = low;
  for (std::size_t i = first; i < levels.size(); ++i) {
    low = std::min(low, levels[i].value);
    high = std::max(high, levels[i].value);
  }
  return high - low;
}

/// Distance from one answer to the farthest of those from `first` on.
double farthest_from(const std::vector<Level>& levels, std::size_t i, std::size_t first) {
  double out = 0;
  for (std::size_t k = first; k < levels.size(); ++k) out = std::max(out, std::abs(levels[k].value - levels[i].value));
  return out;
}

/// How far beyond the finest answer the limit lies where the last three still go one way, 0 where they do not: what their changes
/// add up to if they go on falling as they do, but no more than they have come.
double beyond_the_finest(const std::vector<Level>& levels) {
  if (levels.size() < 3) return range_of(levels, 0);
  const std::size_t n = levels.size();
  const double before = levels[n - 2].value - levels[n - 3].value, last = levels[n - 1].value - levels[n - 2].value;
  if (!(before * last > 0)) return 0;
  const double come = std::abs(before) + std::abs(last), ratio = last / before;
  return ratio < 1 ? std::min(come, kSafety * std::abs(last) * ratio / (1 - ratio)) : come;
}

double rounding_of(const std::vector<Level>& levels) {
  double largest = 0;
  for (const Level& level : levels) largest = std::max(largest, std::abs(level.value));
  return kRounding * std::max(largest, 1e-3);
}

Convergence by_range(const std::vector<Level>& levels, double rounding) {
  Convergence out;
  out.order = std::numeric_limits<double>::quiet_NaN();
  out.limit = levels.back().value;
  const std::size_t n = levels.size();
  out.trust = range_of(levels, 0) <= 10 * rounding ? Trust::exact : Trust::range;
  out.beyond = beyond_the_finest(levels);
  for (std::size_t i = 0; i < n; ++i) {
    out.error.push_back(levels[i].value - out.limit);
    // holds what this and finer steps answer, and the limit where that lies beyond the finest
    const std::size_t third = n > 3 ? n - 3 : 0;
    out.band.push_back(std::max(farthest_from(levels, i, std::min(i, third)) + out.beyond, rounding));
  }
  return out;
}

Convergence by_order(const std::vector<Level>& levels, std::size_t first, std::size_t last, double rounding) {
  Convergence out;
  const FittedOrder fit = fit_order(levels, first, last);
  out.trust = Trust::steady;
  out.order = fit.order;
  // levels finer than the window differ by rounding only: they are the limit
  out.limit = last + 1 < levels.size() ? levels.back().value : fit.limit;
  out.first = static_cast<int>(first);
  out.last = static_cast<int>(last);
  for (const Level& level : levels) {
    const double error = level.value - out.limit;
    const double expected = std::abs(fit.slope) * std::pow(level.step / levels[last].step, fit.order);
    out.error.push_back(error);
    const double misfit = std::abs(std::abs(error) - expected);
    out.band.push_back(kSafety * std::max(std::abs(error), expected) + misfit + 10 * rounding);
  }
  return out;
}

}  // namespace

const char* name_of(Trust trust) {
  constexpr const char* kNames[] = {"steady", "range", "exact"};
  return kNames[static_cast<int>(trust)];
}

Convergence converge(const std::vector<Level>& levels) {
  assert(levels.size() >= 2 && "a ladder has two rungs at least");
  const double rounding = rounding_of(levels);
  // the finest window that differs by more than rounding and has one sequence of contacts
  std::size_t last = levels.size() - 1;
  while (last > 0 && std::abs(levels[last].value - levels[last - 1].value) <= 30 * rounding) --last;
  std::size_t earliest = last;
  while (earliest > 0 && levels[earliest - 1].comparable && levels[earliest].comparable) --earliest;
  // the longest window speaks for most levels, so it is asked first
  for (std::size_t first = earliest; first + kFewestLevels <= last + 1; ++first)
    if (steady(levels, first, last)) return by_order(levels, first, last, rounding);
  return by_range(levels, rounding);
}

Convergence range_only(const std::vector<Level>& levels) {
  return by_range(levels, rounding_of(levels));
}

}  // namespace cli::study
