// crashreel fit: which inputs explain the evidence, and how sure is that.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/inference/posterior.h"
#include "cli/inference/table.h"
#include "render/charts/page.h"

namespace cli::inference {

/// log of the evidence's probability in a run, without `left_out` (-1: with all): minus half the squares of its misfits. Minus
/// infinity for a run that failed.
double log_likelihood(const Row&, int left_out = -1);

/// What is said of one input.
struct Interval {
  double mean = 0, sd = 0, low = 0, median = 0, high = 0;  // SI; low and high hold 95 %
};
Interval interval_of(const std::vector<double>& values, const std::vector<double>& weights);

/// One piece of evidence, held against what all others make of the inputs.
struct Check {
  std::string name;
  std::vector<Interval> predicted;  // by component, from the posterior of all pieces
  double missing = 0;               // weight of runs that have no such thing
  double p_value = 1;               // how probable something as far off is, if the other pieces, the prior and the model are right
  double nearest = 0;               // least misfit of all runs
  double effective = 0;             // of the posterior without it
  std::vector<Interval> removed;    // by input: what the others say without it
};

struct Fit {
  Table table;
  std::vector<double> log_ratios;  // prior over proposals, by run
  Weighted posterior;
  std::vector<std::vector<double>> values;  // by input, then run
  std::vector<Interval> inputs;
  std::vector<std::vector<Mode>> modes;  // by input
  std::vector<int> ends;                 // by input: piled up at the low (-1) or high (1) end of what was held possible
  std::vector<Check> checks;
  std::size_t best = 0;  // run with the least misfit
  double best_misfit = 0;
  double best_p = 1;  // probability that chance alone leaves the best run as far off
  bool contradiction = false;
  std::vector<std::string> reasons;  // why no single number may be given; empty: it may
  std::vector<std::pair<std::string, int>> failures;
  std::uint64_t seed = 0;
};

/// Everything that follows from rows with answers. Throws UsageError when some evidence is of a measure no run has.
Fit conclude(const Prior&, const std::vector<scenes::Evidence>&, Table, std::vector<double> log_ratios, std::uint64_t seed);

/// A single number needs as many effective runs.
constexpr double kEnoughRuns = 200;
/// A piece of evidence less probable than this contradicts the others.
constexpr double kContradicts = 0.01;

/// "What if" from the same posterior.
struct ButFor {
  std::string change;                                               // "vehicle.sedan.speed=30 km/h"
  std::string unanswered;                                           // why; empty: answered
  std::size_t runs = 0, met_before = 0, met_after = 0, failed = 0;  // of equally probable runs
  double avoided = 0, low = 0, high = 0;                            // probability that they would not have met, with its 95 % range
  struct Severity {
    std::string name;
    Interval before, after;
  };
  std::vector<Severity> severities;
};
/// `members` of the posterior as it was, `after` the same ones with the change.
ButFor compare(const std::string& change, const std::vector<Answer>& before, const std::vector<Answer>& after);
/// Rows drawn by weight, evenly; each as often as its weight says.
std::vector<std::size_t> drawn(const Weighted&, int count);

/// How often intervals hold the truth: rows of the prior taken as truth in turn, their evidence with noise, the others as the
/// table.
struct Calibration {
  std::string key;
  int cases = 0, inside_90 = 0;
  std::vector<int> ranks;  // 10 bins of the share of the posterior below the truth
  double chi_squared = 0;  // of the bins against evenness
  double median_effective = 0;
};
std::vector<Calibration> calibrate(const Prior&, const std::vector<scenes::Evidence>&, const Table& from_prior, int cases,
                                   std::uint64_t seed);

nlohmann::ordered_json fit_json(const scenes::Scene&, const Prior&, const Fit&, const std::vector<ButFor>&,
                                const std::vector<Calibration>&);
std::string posterior_csv(const Prior&, const std::vector<scenes::Evidence>&, const Fit&);
std::vector<std::string> sentences(const scenes::Scene&, const Prior&, const Fit&, const std::vector<ButFor>&);
render::charts::Page fit_page(const scenes::Scene&, const Prior&, const Fit&, const std::vector<ButFor>&);

}  // namespace cli::inference
