#include "cli/inference/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>

#include "cli/exit.h"
#include "cli/inference/observe.h"
#include "cli/inference/sample.h"
#include "scenes/loader/value.h"

namespace cli::inference {
namespace {

using scenes::Evidence;
using scenes::Seen;

constexpr double kTooFar = 4;  // [tolerances] evidence no run comes nearer to is out of reach: one in 16,000 by chance

bool is_touch(const Evidence& e) {
  return e.seen == Seen::contact || e.seen == Seen::no_contact;
}

/// Weights of the posterior without one piece of evidence.
Weighted without(const Table& table, const std::vector<double>& log_ratios, int left_out) {
  std::vector<double> logs(log_ratios);
  for (std::size_t i = 0; i < logs.size(); ++i) logs[i] += log_likelihood(table.rows[i], left_out);
  return normalised(logs);
}

/// Two-sided tail of what was seen under runs with these weights, each blurred by the tolerance; the least of its components, times
/// their number.
double tail(const Evidence& e, std::size_t piece, const Table& table, const std::vector<double>& weights) {
  std::vector<double> below(e.value.size(), 0);
  double present = 0, far = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    const auto& predicted = table.rows[i].answer.predicted[piece];
    if (!predicted) continue;
    present += weights[i];
    for (std::size_t k = 0; k < below.size(); ++k)
      below[k] += weights[i] * normal_share((e.value[k] - (*predicted)[k]) / e.tolerance);
    if (e.seen == Seen::mark) far += weights[i] * 2 * normal_share(-(*predicted)[0] / e.tolerance);
    if (is_touch(e) && (*predicted)[0] == e.value[0]) far += weights[i];
  }
  if (e.seen == Seen::mark || is_touch(e)) return far;
  double least = 1;
  for (const double b : below) least = std::min(least, 2 * std::min(b, present - b) * static_cast<double>(below.size()));
  return std::clamp(least, 0.0, 1.0);
}

Check check(const std::vector<Evidence>& evidence, std::size_t piece, const Fit& fit) {
  const Evidence& e = evidence[piece];
  Check out;
  out.name = e.name;
  std::vector<std::vector<double>> values(e.value.size());
  std::vector<double> weights;
  out.nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < fit.table.rows.size(); ++i) {
    const Row& row = fit.table.rows[i];
    if (!row.answer.ok()) continue;
    out.nearest = std::min(out.nearest, row.misfits[piece]);
    if (!row.answer.predicted[piece]) {
      out.missing += fit.posterior.weights[i];
      continue;
    }
    weights.push_back(fit.posterior.weights[i]);
    for (std::size_t k = 0; k < values.size(); ++k) values[k].push_back((*row.answer.predicted[piece])[k]);
  }
  for (const auto& component : values) out.predicted.push_back(interval_of(component, weights));
  const Weighted others = without(fit.table, fit.log_ratios, static_cast<int>(piece));
  out.effective = others.effective;
  out.p_value = tail(e, piece, fit.table, others.weights);
  for (const auto& input : fit.values) out.removed.push_back(interval_of(input, others.weights));
  return out;
}

/// Evidence of a measure that no run has at all is a slip of the pen.
void refuse_unknown_measures(const std::vector<Evidence>& evidence, const Table& table) {
  const std::vector<std::string> names = outputs_of(table);
  for (std::size_t piece = 0; piece < evidence.size(); ++piece) {
    const Evidence& e = evidence[piece];
    const bool seen = std::any_of(table.rows.begin(), table.rows.end(),
                                  [&](const Row& row) { return row.answer.ok() && row.answer.predicted[piece].has_value(); });
    if (seen || e.seen != Seen::metric || table.rows.empty()) continue;
    const std::string near = scenes::nearest(e.metric, names);
    throw UsageError(fmt::format("{}: evidence {}: no run has the measure {}{}{}; the runs have {}", e.place, e.name, e.metric,
                                 e.of.empty() ? "" : " of " + e.of, near.empty() ? "" : fmt::format("; did you mean {}?", near),
                                 fmt::join(names, ", ")));
  }
}

void find_best(const std::vector<Evidence>& evidence, Fit& fit) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < fit.table.rows.size(); ++i) {
    const double off = -2 * log_likelihood(fit.table.rows[i]);
    if (off < least) least = off, fit.best = i;
  }
  fit.best_misfit = std::sqrt(least);
  double components = 0;
  for (const Evidence& e : evidence) components += static_cast<double>(e.value.size());
  if (components > 0 && std::isfinite(least))
    fit.best_p = boost::math::cdf(boost::math::complement(boost::math::chi_squared(components), least));
}

/// As many more as there are too few effective ones, and a quarter besides: their share varies from fit to fit. In hundreds.
long runs_that_should_do(const Fit& fit) {
  const double runs = static_cast<double>(fit.table.rows.size()) * kEnoughRuns / std::max(1.0, fit.posterior.effective);
  return 100 * static_cast<long>(std::ceil(1.25 * runs / 100));
}

void find_reasons(const Prior& prior, const std::vector<Evidence>& evidence, Fit& fit) {
  for (const Check& c : fit.checks)
    if (c.nearest > kTooFar)
      fit.reasons.push_back(
          fmt::format("no run comes near the evidence \"{}\": the nearest is {:.1f} tolerances off. The evidence, its "
                      "tolerance, the ranges of the inputs or the model is wrong",
                      c.name, c.nearest));
  std::vector<std::string> apart;
  for (const Check& c : fit.checks)
    if (c.p_value < kContradicts / static_cast<double>(fit.checks.size())) apart.push_back("\"" + c.name + "\"");
  if (!apart.empty() || fit.best_p < kContradicts || !fit.reasons.empty()) fit.contradiction = true;
  if (fit.contradiction && evidence.size() > 1)
    fit.reasons.push_back(fmt::format("the pieces of evidence contradict each other or the model{}{}",
                                      apart.empty() ? "" : ", first of all ", fmt::join(apart, ", ")));
  else if (fit.contradiction && fit.reasons.empty())
    fit.reasons.push_back("the evidence contradicts what was held possible beforehand, or the model");
  if (fit.posterior.effective < kEnoughRuns)
    fit.reasons.push_back(
        fmt::format("only {:.0f} effective runs carry the answer, {:.0f} are needed: give more runs, -n {} should do",
                    fit.posterior.effective, kEnoughRuns, runs_that_should_do(fit)));
  for (std::size_t i = 0; i < fit.inputs.size(); ++i) {
    const auto& input = prior.inputs()[i];
    if (fit.ends[i] != 0)
      fit.reasons.push_back(
          fmt::format("{} is likeliest at the {} end of what was held possible: the range decides the answer, not the "
                      "evidence. Widen it, or say why nothing lies beyond",
                      input.key, fit.ends[i] < 0 ? "lower" : "upper"));
    if (fit.modes[i].size() > 1 && fit.posterior.effective >= kEnoughRuns)
      fit.reasons.push_back(
          fmt::format("{} has {} ranges apart from each other that explain the evidence", input.key, fit.modes[i].size()));
  }
}

}  // namespace

double log_likelihood(const Row& row, int left_out) {
  if (!row.answer.ok()) return -std::numeric_limits<double>::infinity();
  double sum = 0;
  for (std::size_t e = 0; e < row.misfits.size(); ++e)
    if (static_cast<int>(e) != left_out) sum += row.misfits[e] * row.misfits[e];
  return -0.5 * sum;
}

Interval interval_of(const std::vector<double>& values, const std::vector<double>& weights) {
  return {mean_of(values, weights), sd_of(values, weights), quantile_of(values, weights, 0.025), quantile_of(values, weights, 0.5),
          quantile_of(values, weights, 0.975)};
}

Fit conclude(const Prior& prior, const std::vector<Evidence>& evidence, Table table, std::vector<double> log_ratios,
             std::uint64_t seed) {
  refuse_unknown_measures(evidence, table);
  Fit fit;
  fit.seed = seed;
  fit.failures = failures_of(table);
  fit.table = std::move(table);
  fit.log_ratios = std::move(log_ratios);
  fit.posterior = without(fit.table, fit.log_ratios, -1);
  fit.values.resize(static_cast<std::size_t>(prior.size()));
  std::vector<std::vector<double>> shares(fit.values.size());
  for (const Row& row : fit.table.rows) {
    const std::vector<double> u = prior.shares(row.scores);
    for (std::size_t i = 0; i < fit.values.size(); ++i) {
      fit.values[i].push_back(row.values[i]);
      shares[i].push_back(u[i]);
    }
  }
  for (std::size_t i = 0; i < fit.values.size(); ++i) {
    const scenes::Uncertain& input = prior.inputs()[i];
    const bool number = input.spread != scenes::Spread::choice;
    const bool ends = input.bounded() || std::isfinite(input.lower) || std::isfinite(input.upper);
    fit.inputs.push_back(interval_of(fit.values[i], fit.posterior.weights));
    fit.modes.push_back(number ? modes_of(fit.values[i], fit.posterior) : std::vector<Mode>());
    fit.ends.push_back(number && ends ? piled_at_end(shares[i], fit.posterior.weights) : 0);
  }
  find_best(evidence, fit);
  for (std::size_t e = 0; e < evidence.size(); ++e) fit.checks.push_back(check(evidence, e, fit));
  find_reasons(prior, evidence, fit);
  return fit;
}

}  // namespace cli::inference
