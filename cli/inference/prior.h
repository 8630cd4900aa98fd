// What is known of the inputs before a run is held against evidence: [[uncertain]] as a map from independent normal scores.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "scenes/inference.h"

namespace cli::inference {

/// Standard normal density's integral up to z, and its inverse.
double normal_share(double z);
double normal_score(double share);

/// Value below which `share` (0..1) of the spread lies, SI; of a choice, the number of the choice.
double quantile(const scenes::Uncertain&, double share);

/// The inputs are functions of as many independent standard normal scores: correlated first (a Gaussian copula), then through each
/// one's quantiles. In scores the prior is the same for every scene.
class Prior {
 public:
  explicit Prior(std::vector<scenes::Uncertain> inputs);
  int size() const { return static_cast<int>(inputs_.size()); }
  const std::vector<scenes::Uncertain>& inputs() const { return inputs_; }
  bool correlated() const { return correlated_; }

  /// SI, or the number of the choice.
  std::vector<double> values(const std::vector<double>& scores) const;
  /// Each input's own share (0..1), after correlation.
  std::vector<double> shares(const std::vector<double>& scores) const;
  /// "path.to.key=12.3 m/s" for each.
  std::vector<std::string> overrides(const std::vector<double>& values) const;

 private:
  std::vector<scenes::Uncertain> inputs_;
  Eigen::MatrixXd mixing_;  // lower triangle L with correlation = L L^T
  bool correlated_ = false;
};

}  // namespace cli::inference
