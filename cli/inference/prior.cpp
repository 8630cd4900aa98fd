#include "cli/inference/prior.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace cli::inference {
namespace {

using scenes::Spread;
using scenes::Uncertain;

const boost::math::normal kNormal;

double of_triangle(const std::vector<double>& n, double share) {
  const double span = n[2] - n[0], left = n[1] - n[0];
  return share * span < left ? n[0] + std::sqrt(share * span * left) : n[2] - std::sqrt((1 - share) * span * (n[2] - n[1]));
}

/// Density by straight lines: the area of each piece, then a quadratic within the piece.
double of_table(const Uncertain& u, double share) {
  std::vector<double> area(u.numbers.size(), 0);
  for (std::size_t i = 1; i < area.size(); ++i)
    area[i] = area[i - 1] + 0.5 * (u.weights[i] + u.weights[i - 1]) * (u.numbers[i] - u.numbers[i - 1]);
  const double wanted = share * area.back();
  std::size_t i = 1;
  while (i + 1 < area.size() && area[i] < wanted) ++i;
  const double width = u.numbers[i] - u.numbers[i - 1], rest = wanted - area[i - 1];
  const double low = u.weights[i - 1], slope = (u.weights[i] - low) / width;
  // low x + slope x^2 / 2 = rest, in the form that bears a slope of zero
  const double root = std::sqrt(std::max(0.0, low * low + 2 * slope * rest));
  return u.numbers[i - 1] + (low + root > 0 ? std::min(width, 2 * rest / (low + root)) : 0);
}

double of_choice(const Uncertain& u, double share) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < u.weights.size(); ++i)
    if (share < (sum += u.weights[i])) return static_cast<double>(i);
  return static_cast<double>(u.weights.size() - 1);
}

/// The share within the part of a normal that is possible.
double cut_score(double low, double high, double share) {
  const double from = std::isfinite(low) ? normal_share(low) : 0, to = std::isfinite(high) ? normal_share(high) : 1;
  return normal_score(from + share * (to - from));
}

}  // namespace

double normal_share(double z) {
  return boost::math::cdf(kNormal, z);
}

double normal_score(double share) {
  return boost::math::quantile(kNormal, std::clamp(share, 1e-300, 1 - 1e-16));
}

double quantile(const Uncertain& u, double share) {
  const std::vector<double>& n = u.numbers;
  switch (u.spread) {
    case Spread::uniform:
      return n[0] + share * (n[1] - n[0]);
    case Spread::normal:
      return n[0] + n[1] * cut_score((u.lower - n[0]) / n[1], (u.upper - n[0]) / n[1], share);
    case Spread::log_normal: {
      const double sigma = std::log(n[1]), low = u.lower > 0 ? std::log(u.lower / n[0]) / sigma : u.lower;
      return n[0] * std::exp(sigma * cut_score(u.lower > 0 ? low : -std::numeric_limits<double>::infinity(),
                                               std::log(u.upper / n[0]) / sigma, share));
    }
    case Spread::triangular:
      return of_triangle(n, share);
    case Spread::table:
      return of_table(u, share);
    case Spread::choice:
      return of_choice(u, share);
  }
  return 0;
}

Prior::Prior(std::vector<Uncertain> inputs) : inputs_(std::move(inputs)) {
  const auto n = static_cast<Eigen::Index>(inputs_.size());
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (const auto& [other, value] : inputs_[static_cast<std::size_t>(i)].correlation)
      for (Eigen::Index k = 0; k < n; ++k)
        if (inputs_[static_cast<std::size_t>(k)].key == other) {
          correlation(i, k) = correlation(k, i) = value;
          correlated_ = correlated_ || value != 0;
        }
  mixing_ = correlation.llt().matrixL();
}

std::vector<double> Prior::shares(const std::vector<double>& scores) const {
  const Eigen::VectorXd mixed =
      mixing_ * Eigen::Map<const Eigen::VectorXd>(scores.data(), static_cast<Eigen::Index>(scores.size()));
  std::vector<double> out;
  for (const double z : mixed) out.push_back(normal_share(z));
  return out;
}

std::vector<double> Prior::values(const std::vector<double>& scores) const {
  std::vector<double> out = shares(scores);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = quantile(inputs_[i], out[i]);
  return out;
}

std::vector<std::string> Prior::overrides(const std::vector<double>& values) const {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const Uncertain& u = inputs_[i];
    if (u.spread == Spread::choice)
      out.push_back(fmt::format("{}={}", u.key, u.choices[static_cast<std::size_t>(values[i])]));
    else
      out.push_back(fmt::format("{}={}{}{}", u.key, values[i], u.si_unit.empty() ? "" : " ", u.si_unit));
  }
  return out;
}

}  // namespace cli::inference
