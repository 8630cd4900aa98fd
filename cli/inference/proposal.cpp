#include "cli/inference/proposal.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "cli/inference/prior.h"
#include "cli/inference/sequence.h"
#include "engine/math/roots.h"

namespace cli::inference {
namespace {

constexpr int kKernels = 150;
constexpr double kOfPrior = 0.1;   // share of the prior in every proposal
constexpr double kNearest = 0.25;  // of the weight: what shapes a kernel
constexpr double kWider = 1.3;     // than the cloud it stands for: tails of a proposal must not be thinner than the posterior's

/// Indices drawn by weight, evenly spaced over the sum of weights.
std::vector<std::size_t> resampled(const std::vector<double>& weights, int count, double shift) {
  std::vector<std::size_t> out;
  double sum = 0;
  std::size_t i = 0;
  for (int k = 0; k < count; ++k) {
    const double wanted = (k + shift) / count;
    while (i + 1 < weights.size() && sum + weights[i] < wanted) sum += weights[i++];
    out.push_back(i);
  }
  return out;
}

double log_sum(const std::vector<double>& logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0;
  for (const double l : logs) sum += std::exp(l - most);
  return most + std::log(sum);
}

/// Weighted covariance about their own mean.
Eigen::MatrixXd covariance_of(const std::vector<Eigen::VectorXd>& z, const std::vector<double>& w,
                              const std::vector<std::size_t>& of) {
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(z[0].size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(z[0].size(), z[0].size());
  double sum = 0;
  for (const std::size_t i : of) mean += w[i] * z[i], sum += w[i];
  mean /= sum;
  for (const std::size_t i : of) out += w[i] / sum * (z[i] - mean) * (z[i] - mean).transpose();
  return out;
}

}  // namespace

Proposal::Proposal(int dimensions) : dimensions_(dimensions) {
  add(Eigen::VectorXd::Zero(dimensions), Eigen::MatrixXd::Identity(dimensions, dimensions), 1);
}

Proposal::Proposal(const Scores& points, const Weighted& weighted, std::uint64_t seed)
    : dimensions_(static_cast<int>(points[0].size())) {
  std::vector<Eigen::VectorXd> z;
  std::vector<double> w;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(weighted.weights[i] > 1e-6)) continue;
    z.push_back(Eigen::Map<const Eigen::VectorXd>(points[i].data(), dimensions_));
    w.push_back(weighted.weights[i]);
  }
  std::vector<std::size_t> all(z.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Eigen::MatrixXd whole = covariance_of(z, w, all);
  // distances in the cloud's own measure; a floor keeps a kernel from falling into one point
  const Eigen::MatrixXd floor = 1e-4 * whole + 1e-10 * Eigen::MatrixXd::Identity(dimensions_, dimensions_);
  const Eigen::MatrixXd metric = (whole + floor).inverse();
  const double shift = static_cast<double>(mixed(seed) >> 11) * 0x1p-53;
  for (const std::size_t centre : resampled(w, kKernels, shift)) {
    std::vector<double> distance(z.size());
    for (std::size_t i = 0; i < z.size(); ++i) distance[i] = (z[i] - z[centre]).dot(metric * (z[i] - z[centre]));
    std::vector<std::size_t> order = all;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return distance[a] < distance[b]; });
    double sum = 0;
    std::size_t count = 0;
    while (count < order.size() && (sum < kNearest || static_cast<int>(count) < dimensions_ + 2)) sum += w[order[count++]];
    order.resize(count);
    add(z[centre], kWider * kWider * covariance_of(z, w, order) + floor, (1 - kOfPrior) / kKernels);
  }
  add(Eigen::VectorXd::Zero(dimensions_), Eigen::MatrixXd::Identity(dimensions_, dimensions_), kOfPrior);
}

void Proposal::add(Eigen::VectorXd centre, const Eigen::MatrixXd& covariance, double share) {
  Kernel k;
  k.centre = std::move(centre);
  k.triangle = covariance.llt().matrixL();
  k.inverse = k.triangle.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(dimensions_, dimensions_));
  k.share = share;
  k.log_share = std::log(share) - k.triangle.diagonal().array().log().sum() - 0.5 * dimensions_ * std::log(2 * M_PI);
  kernels_.push_back(std::move(k));
}

Scores Proposal::draw(std::uint64_t count, std::uint64_t seed) const {
  // the first coordinate picks the kernel, the others the place within it: both evenly
  const Scores points = scrambled_points(dimensions_ + 1, 0, count, seed);
  Scores out;
  for (const std::vector<double>& point : points) {
    std::size_t k = 0;
    double sum = kernels_[0].share;
    while (k + 1 < kernels_.size() && sum < point[0]) sum += kernels_[++k].share;
    Eigen::VectorXd e(dimensions_);
    for (int i = 0; i < dimensions_; ++i) e[i] = normal_score(point[static_cast<std::size_t>(i) + 1]);
    const Eigen::VectorXd z = kernels_[k].centre + kernels_[k].triangle * e;
    out.emplace_back(z.begin(), z.end());
  }
  return out;
}

double Proposal::log_density(const std::vector<double>& point) const {
  const Eigen::Map<const Eigen::VectorXd> z(point.data(), dimensions_);
  std::vector<double> logs;
  for (const Kernel& k : kernels_) logs.push_back(k.log_share - 0.5 * (k.inverse * (z - k.centre)).squaredNorm());
  return log_sum(logs);
}

void Mixture::add(Proposal proposal, const Scores& points) {
  for (std::size_t t = 0; t < proposals_.size(); ++t)
    for (const auto& z : points) log_q_[t].push_back(proposals_[t].log_density(z));
  points_.insert(points_.end(), points.begin(), points.end());
  log_q_.emplace_back();
  for (const auto& z : points_) log_q_.back().push_back(proposal.log_density(z));
  proposals_.push_back(std::move(proposal));
  counts_.push_back(static_cast<double>(points.size()));
}

std::vector<double> Mixture::log_ratios() const {
  const double total = std::accumulate(counts_.begin(), counts_.end(), 0.0);
  std::vector<double> out;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    std::vector<double> logs;
    for (std::size_t t = 0; t < proposals_.size(); ++t) logs.push_back(std::log(counts_[t] / total) + log_q_[t][i]);
    double log_prior = -0.5 * static_cast<double>(points_[i].size()) * std::log(2 * M_PI);
    for (const double z : points_[i]) log_prior -= 0.5 * z * z;
    out.push_back(log_prior - log_sum(logs));
  }
  return out;
}

std::vector<double> tempered(const std::vector<double>& log_ratios, const std::vector<double>& log_likelihoods, double wanted) {
  const auto at = [&](double t) {
    std::vector<double> out(log_ratios);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = std::isfinite(log_likelihoods[i]) ? out[i] + t * log_likelihoods[i] : -std::numeric_limits<double>::infinity();
    return out;
  };
  if (normalised(at(1)).effective >= wanted) return at(1);
  return at(engine::math::bisect({0, 1}, 40, 0, [&](double t) { return normalised(at(t)).effective >= wanted; }).low);
}

}  // namespace cli::inference
