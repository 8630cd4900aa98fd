// Where to run next: a cloud of kernels over the runs that explain the evidence, in independent normal scores.
//
// Importance sampling with several proposals q_1 .. q_T of n_1 .. n_T points each (adaptive multiple importance sampling, Cornuet
// et al. 2012): every point z, whichever proposal it came from, has the weight
//   w(z) = p(z) L(z) / ((sum_t n_t q_t(z)) / (sum_t n_t)),   p the prior, L the likelihood of the evidence.
// The first proposal is the prior itself, so the ratio p/q is bounded and no part of the prior is lost. The weights need no
// gradient and no smooth L: where near starts end far apart, each run counts with its own outcome, and the scatter is averaged over
// as the integral over z demands.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "cli/inference/posterior.h"

namespace cli::inference {

using Scores = std::vector<std::vector<double>>;

class Proposal {
 public:
  /// The prior: one standard normal kernel.
  explicit Proposal(int dimensions);
  /// Kernels at points drawn by weight, each as wide as the quarter of the weight nearest to it; and a tenth of the prior.
  Proposal(const Scores& points, const Weighted& weights, std::uint64_t seed);

  Scores draw(std::uint64_t count, std::uint64_t seed) const;
  double log_density(const std::vector<double>& z) const;

 private:
  struct Kernel {
    Eigen::VectorXd centre;
    Eigen::MatrixXd triangle;  // covariance = triangle triangle^T
    Eigen::MatrixXd inverse;   // of the triangle
    double log_share = 0;      // of the mixture, with the normal's factor
    double share = 0;
  };
  void add(Eigen::VectorXd centre, const Eigen::MatrixXd& covariance, double share);

  int dimensions_;
  std::vector<Kernel> kernels_;
};

/// log of p / q for points that came from several proposals.
class Mixture {
 public:
  void add(Proposal proposal, const Scores& points);
  const Scores& points() const { return points_; }
  std::vector<double> log_ratios() const;

 private:
  std::vector<Proposal> proposals_;
  std::vector<double> counts_;
  Scores points_;
  std::vector<std::vector<double>> log_q_;  // by proposal and point
};

/// Log weights log_ratio + T log_likelihood with the largest T <= 1 that leaves at least `wanted` effective points: a proposal made
/// from a handful of points would miss what lies beside them.
std::vector<double> tempered(const std::vector<double>& log_ratios, const std::vector<double>& log_likelihoods, double wanted);

}  // namespace cli::inference
