// What would have happened otherwise, and how often intervals hold the truth: both from runs that are there.
#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <cmath>
#include <set>

#include "cli/inference/fit.h"
#include "cli/inference/sequence.h"
#include "cli/study/statistics.h"

namespace cli::inference {
namespace {

constexpr const char* kSeverities[] = {"head_impact_speed_mps", "delta_v_mps", "throw_distance_m", "ees_mps"};

bool is_severity(const std::string& name) {
  return std::any_of(std::begin(kSeverities), std::end(kSeverities), [&](const char* s) { return name.starts_with(s); });
}

/// Of those runs that have it.
Interval interval_of(const std::vector<Answer>& answers, const std::string& name) {
  std::vector<double> values;
  for (const Answer& a : answers)
    if (const auto found = a.outputs.find(name); found != a.outputs.end() && std::isfinite(found->second))
      values.push_back(found->second);
  return inference::interval_of(values, std::vector<double>(values.size(), 1.0));
}

/// A normal deviate that hangs on its number alone.
double deviate(std::uint64_t number) {
  return normal_score((static_cast<double>(mixed(number) >> 11) + 0.5) * 0x1p-53);
}

}  // namespace

std::vector<std::size_t> drawn(const Weighted& w, int count) {
  std::vector<std::size_t> out;
  double sum = 0;
  std::size_t i = 0;
  for (int k = 0; k < count; ++k) {
    while (i + 1 < w.weights.size() && sum + w.weights[i] < (k + 0.5) / count) sum += w.weights[i++];
    out.push_back(i);
  }
  return out;
}

ButFor compare(const std::string& change, const std::vector<Answer>& before, const std::vector<Answer>& after) {
  ButFor out;
  out.change = change;
  std::set<std::string> names;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!after[i].ok()) {
      ++out.failed;
      continue;
    }
    ++out.runs;
    out.met_before += before[i].touched;
    out.met_after += before[i].touched && after[i].touched;
    for (const auto& [name, value] : before[i].outputs)
      if (is_severity(name)) names.insert(name);
  }
  if (out.met_before > 0) {
    const double avoided = static_cast<double>(out.met_before - out.met_after), met = static_cast<double>(out.met_after);
    // Jeffreys' interval of a share
    const boost::math::beta_distribution<> share(avoided + 0.5, met + 0.5);
    out.avoided = avoided / (avoided + met);
    out.low = avoided > 0 ? boost::math::quantile(share, 0.025) : 0;
    out.high = met > 0 ? boost::math::quantile(share, 0.975) : 1;
  }
  for (const std::string& name : names) out.severities.push_back({name, interval_of(before, name), interval_of(after, name)});
  return out;
}

std::vector<Calibration> calibrate(const Prior& prior, const std::vector<scenes::Evidence>& evidence, const Table& table, int cases,
                                   std::uint64_t seed) {
  std::vector<Calibration> out(static_cast<std::size_t>(prior.size()));
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].key = prior.inputs()[i].key;
    out[i].ranks.assign(10, 0);
  }
  std::vector<double> effective;
  for (std::size_t truth = 0; truth < table.rows.size() && static_cast<int>(effective.size()) < cases; ++truth) {
    const Row& row = table.rows[truth];
    const auto& seen = row.answer.predicted;
    if (!row.answer.ok() || std::any_of(seen.begin(), seen.end(), [](const auto& p) { return !p; })) continue;
    std::vector<scenes::Evidence> noisy(evidence);
    for (std::size_t e = 0; e < noisy.size(); ++e)
      for (std::size_t k = 0; k < noisy[e].value.size(); ++k) {
        const bool exact = noisy[e].seen == scenes::Seen::contact || noisy[e].seen == scenes::Seen::no_contact;
        noisy[e].value[k] = (*seen[e])[k] + (exact ? 0 : noisy[e].tolerance * deviate(mixed(seed) + truth * 1009 + e * 31 + k));
      }
    Table others;
    others.rows = table.rows;
    others.rows[truth].answer.status = "the truth itself";
    judge(noisy, others);
    std::vector<double> logs;
    for (const Row& other : others.rows) logs.push_back(log_likelihood(other));
    const Weighted posterior = normalised(logs);
    effective.push_back(posterior.effective);
    for (std::size_t i = 0; i < out.size(); ++i) {
      std::vector<double> values;
      double below = 0;
      for (std::size_t r = 0; r < table.rows.size(); ++r) {
        values.push_back(table.rows[r].values[i]);
        if (values.back() < row.values[i]) below += posterior.weights[r];
      }
      const double low = quantile_of(values, posterior.weights, 0.05), high = quantile_of(values, posterior.weights, 0.95);
      out[i].inside_90 += low <= row.values[i] && row.values[i] <= high;
      ++out[i].ranks[static_cast<std::size_t>(std::clamp(below * 10, 0.0, 9.0))];
      ++out[i].cases;
    }
  }
  for (Calibration& c : out) {
    const double expected = c.cases / 10.0;
    for (const int r : c.ranks) c.chi_squared += expected > 0 ? (r - expected) * (r - expected) / expected : 0;
    c.median_effective = study::median(effective);
  }
  return out;
}

}  // namespace cli::inference
