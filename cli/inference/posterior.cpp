#include "cli/inference/posterior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace cli::inference {
namespace {

/// Order of the runs by value.
std::vector<std::size_t> sorted(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  return order;
}

constexpr int kModePoints = 400;
constexpr double kLeastShare = 0.1;  // of the weight: what a hill must hold to be told of
constexpr double kValley = 0.5;      // of the lower hill: deeper, and there are two

}  // namespace

Weighted normalised(const std::vector<double>& log_weights) {
  Weighted out;
  out.weights.assign(log_weights.size(), 0);
  double most = -std::numeric_limits<double>::infinity();
  for (const double l : log_weights) most = std::max(most, l);
  if (!std::isfinite(most)) return out;
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < log_weights.size(); ++i) sum += out.weights[i] = std::exp(log_weights[i] - most);
  for (double& w : out.weights) {
    w /= sum;
    squares += w * w;
  }
  out.effective = 1 / squares;
  return out;
}

double mean_of(const std::vector<double>& values, const std::vector<double>& weights) {
  double sum = 0, total = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (weights[i] > 0) sum += weights[i] * values[i], total += weights[i];
  return sum / total;
}

double sd_of(const std::vector<double>& values, const std::vector<double>& weights) {
  const double mean = mean_of(values, weights);
  double sum = 0, total = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (weights[i] > 0) sum += weights[i] * (values[i] - mean) * (values[i] - mean), total += weights[i];
  return std::sqrt(sum / total);
}

double quantile_of(const std::vector<double>& values, const std::vector<double>& weights, double share) {
  double total = 0, below = 0, last_value = std::numeric_limits<double>::quiet_NaN(), last_middle = 0;
  for (const double w : weights) total += w;
  for (const std::size_t i : sorted(values)) {
    if (!(weights[i] > 0)) continue;
    const double middle = (below + 0.5 * weights[i]) / total;
    if (middle >= share) {
      if (std::isnan(last_value)) return values[i];
      return last_value + (values[i] - last_value) * (share - last_middle) / (middle - last_middle);
    }
    below += weights[i];
    last_value = values[i];
    last_middle = middle;
  }
  return last_value;
}

Density density_of(const std::vector<double>& values, const Weighted& w, double low, double high, int points) {
  Density out;
  // the spread of the middle half, so that two hills far apart do not smear each other
  const double spread = quantile_of(values, w.weights, 0.75) - quantile_of(values, w.weights, 0.25);
  const double sd = sd_of(values, w.weights), rough = spread > 0 ? std::min(sd, spread / 1.34) : sd;
  const double width = std::max(0.9 * rough * std::pow(std::max(2.0, w.effective), -0.2), 1e-9 * (high - low));
  for (int k = 0; k < points; ++k) out.x.push_back(low + (high - low) * k / (points - 1));
  out.y.assign(out.x.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(w.weights[i] > 1e-12)) continue;
    // what the kernel would lay beyond the ends is reflected: nothing is possible there
    for (const double centre : {values[i], 2 * low - values[i], 2 * high - values[i]})
      for (std::size_t k = 0; k < out.x.size(); ++k) {
        const double t = (out.x[k] - centre) / width;
        if (std::abs(t) < 6) out.y[k] += w.weights[i] * std::exp(-0.5 * t * t) / (width * std::sqrt(2 * M_PI));
      }
  }
  return out;
}

std::vector<Mode> modes_of(const std::vector<double>& values, const Weighted& w) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (w.weights[i] > 1e-9) low = std::min(low, values[i]), high = std::max(high, values[i]);
  if (!(high > low)) return {};
  // a kernel of the whole would drown narrow hills far apart: the width of the densest half instead
  std::vector<double> shortest;
  for (double share = 0; share <= 0.75; share += 0.05)
    shortest.push_back(quantile_of(values, w.weights, share + 0.25) - quantile_of(values, w.weights, share));
  const double quarter = *std::min_element(shortest.begin(), shortest.end());
  const double width =
      std::max({1.2 * quarter * std::pow(std::max(2.0, w.effective), -0.2), 2 * (high - low) / kModePoints, 1e-300});
  std::vector<double> x(kModePoints), y(kModePoints, 0.0);
  for (int k = 0; k < kModePoints; ++k) x[k] = low + (high - low) * k / (kModePoints - 1);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (w.weights[i] > 1e-12)
      for (int k = 0; k < kModePoints; ++k) y[k] += w.weights[i] * std::exp(-0.5 * std::pow((x[k] - values[i]) / width, 2));
  // hills and the lowest places between them, shallow valleys filled, lowest first
  std::vector<int> cuts{0, kModePoints - 1};
  std::vector<int> peaks;
  for (int k = 0; k < kModePoints; ++k)
    if ((k == 0 || y[k] > y[k - 1]) && (k + 1 == kModePoints || y[k] >= y[k + 1])) peaks.push_back(k);
  for (bool merged = true; merged && peaks.size() > 1;) {
    merged = false;
    for (std::size_t p = 0; p + 1 < peaks.size() && !merged; ++p) {
      const double valley = *std::min_element(y.begin() + peaks[p], y.begin() + peaks[p + 1] + 1);
      const bool left_lower = y[peaks[p]] < y[peaks[p + 1]];
      if (valley < kValley * std::min(y[peaks[p]], y[peaks[p + 1]])) continue;
      peaks.erase(peaks.begin() + static_cast<std::ptrdiff_t>(left_lower ? p : p + 1));
      merged = true;
    }
  }
  std::vector<Mode> out;
  double from = low - 1;
  for (std::size_t p = 0; p < peaks.size(); ++p) {
    const bool last = p + 1 == peaks.size();
    const double to = last ? high + 1 : x[std::min_element(y.begin() + peaks[p], y.begin() + peaks[p + 1] + 1) - y.begin()];
    std::vector<double> part(w.weights);
    double share = 0;
    for (std::size_t i = 0; i < values.size(); ++i) share += values[i] > from && values[i] <= to ? part[i] : (part[i] = 0);
    from = to;
    if (share >= kLeastShare)
      out.push_back({quantile_of(values, part, 0.025), quantile_of(values, part, 0.975), x[peaks[p]], share});
  }
  return out;
}

int piled_at_end(const std::vector<double>& shares, const std::vector<double>& weights) {
  std::array<double, 20> parts{};
  for (std::size_t i = 0; i < shares.size(); ++i)
    parts[static_cast<std::size_t>(std::clamp(shares[i] * 20, 0.0, 19.0))] += weights[i];
  const auto most = std::max_element(parts.begin(), parts.end());
  if (*most < 3.0 / 20) return 0;
  return most == parts.begin() ? -1 : most == parts.end() - 1 ? 1 : 0;
}

double correlation_of(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& weights) {
  const double ma = mean_of(a, weights), mb = mean_of(b, weights);
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    aa += weights[i] * (a[i] - ma) * (a[i] - ma);
    bb += weights[i] * (b[i] - mb) * (b[i] - mb);
    ab += weights[i] * (a[i] - ma) * (b[i] - mb);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

}  // namespace cli::inference
