// A fit on one page for print.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/inference/fit.h"
#include "cli/inference/sample.h"
#include "cli/scene_run.h"

namespace cli::inference {
namespace {

namespace charts = render::charts;

constexpr std::size_t kMostInputs = 6;  // densities on the page; the others are in fit.json
constexpr int kPoints = 200;

std::string label(const scenes::Uncertain& u) {
  return u.key + (u.unit.name.empty() ? "" : " [" + u.unit.name + "]");
}

/// Prior and posterior density over what the prior holds possible.
charts::Chart density_chart(const scenes::Uncertain& u, std::size_t i, const Fit& fit) {
  charts::Chart chart;
  chart.title = u.key;
  chart.x_label = u.unit.name.empty() ? "value" : u.unit.name;
  chart.y_label = fmt::format("probability {}, before and after", u.unit.name.empty() ? "density" : "per " + u.unit.name);
  const double low = quantile(u, 0.001), high = quantile(u, 0.999), f = u.unit.factor;
  charts::Band after{"after", {}};
  const Density d = density_of(fit.values[i], fit.posterior, low, high, kPoints);
  for (int k = 0; k < kPoints; ++k) after.points.push_back({d.x[k] / f, 0, 0, d.y[k] * f});
  charts::Line before{"before", {}, true, false, 0};
  for (int k = 1; k < kPoints; ++k) {
    const double a = quantile(u, (k - 0.5) / kPoints), b = quantile(u, (k + 0.5) / kPoints);
    before.points.push_back({0.5 * (a + b) / f, f / (kPoints * (b - a)), 0, 0});
  }
  chart.bands.push_back(std::move(after));
  chart.lines.push_back(std::move(before));
  return chart;
}

charts::Chart choice_chart(const scenes::Uncertain& u, std::size_t i, const Fit& fit) {
  charts::Chart chart;
  chart.title = u.key;
  chart.names = u.choices;
  chart.y_label = "probability before and after";
  charts::Line before{"before", {}, false, false}, after{"after", {}, false, true};
  for (std::size_t c = 0; c < u.choices.size(); ++c) {
    double share = 0;
    for (std::size_t r = 0; r < fit.values[i].size(); ++r)
      if (static_cast<std::size_t>(fit.values[i][r]) == c) share += fit.posterior.weights[r];
    before.points.push_back({static_cast<double>(c + 1), u.weights[c], 0, 0});
    after.points.push_back({static_cast<double>(c + 1), share, 0, 0});
  }
  chart.lines = {std::move(after), std::move(before)};
  return chart;
}

/// The two inputs that hang together most after the evidence, as equally probable runs.
charts::Chart joint_chart(const Prior& prior, const Fit& fit) {
  std::size_t a = 0, b = 1;
  double most = -1;
  for (std::size_t i = 0; i < fit.values.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const double c = std::abs(correlation_of(fit.values[i], fit.values[k], fit.posterior.weights));
      if (c > most) most = c, a = k, b = i;
    }
  charts::Chart chart;
  const scenes::Uncertain &x = prior.inputs()[a], &y = prior.inputs()[b];
  chart.title = fmt::format("Together: correlation {:.2f}", correlation_of(fit.values[a], fit.values[b], fit.posterior.weights));
  chart.x_label = label(x);
  chart.y_label = label(y);
  charts::Line cloud{"equally probable runs", {}, false, false, 0.35};
  for (const std::size_t r : drawn(fit.posterior, 400))
    cloud.points.push_back({fit.values[a][r] / x.unit.factor, fit.values[b][r] / y.unit.factor, 0, 0});
  chart.lines.push_back(std::move(cloud));
  return chart;
}

/// Every piece of evidence in tolerances, a place by its components: where all runs that explain the whole have it.
charts::Chart residuals(const scenes::Scene& scene, const Fit& fit) {
  charts::Chart chart;
  chart.title = "Residuals of the evidence";
  chart.y_label = "run less evidence, in tolerances: 95 % range";
  charts::Line line{"", {}, false, true};
  for (std::size_t e = 0; e < fit.checks.size(); ++e) {
    const scenes::Evidence& seen = scene.inference.evidence[e];
    const std::vector<Interval>& predicted = fit.checks[e].predicted;
    for (std::size_t k = 0; k < predicted.size(); ++k) {
      const Interval& p = predicted[k];
      chart.names.push_back(predicted.size() == 1 ? seen.name : fmt::format("{} {}", seen.name, "xyz"[k]));
      if (!std::isfinite(p.mean)) continue;
      const auto off = [&](double v) { return (v - seen.value[k]) / seen.tolerance; };
      line.points.push_back({static_cast<double>(chart.names.size()), off(p.median), off(p.low), off(p.high)});
    }
  }
  chart.lines.push_back(std::move(line));
  chart.levels.push_back({0, 0, ""});
  return chart;
}

/// To an eighth of its width, but no finer than `least`: ends that agree have no digits of their own.
std::string value_in_words(const Interval& i, const scenes::WrittenUnit& unit, double least) {
  const double fine = std::max((i.high - i.low) / 8, least);
  return std::isfinite(i.mean) ? fmt::format("{} to {}", told(i.low, {"", unit.factor}, fine), told(i.high, unit, fine)) : "none";
}

/// What moves when a piece is left out: where the middle of the main input goes.
charts::Bars leave_one_out(const Prior& prior, const Fit& fit, std::size_t main) {
  charts::Bars bars;
  const scenes::Uncertain& u = prior.inputs()[main];
  bars.title = fmt::format("Which piece carries the answer: {} without it", u.key);
  bars.parts = {"its 95 % range grows to", "without it"};
  const double width = fit.inputs[main].high - fit.inputs[main].low;
  for (const Check& c : fit.checks) {
    const Interval& r = c.removed[main];
    const bool enough = c.effective >= kEnoughRuns;
    bars.rows.push_back({c.name,
                         {enough ? std::max(0.0, (r.high - r.low) / width - 1) : 0, 0},
                         {enough ? fmt::format("{:.1f} times", (r.high - r.low) / width) : "too few runs",
                          enough ? value_in_words(r, u.unit, width / 100) : ""}});
  }
  return bars;
}

charts::Table evidence_table(const scenes::Scene& scene, const Fit& fit) {
  charts::Table table;
  table.title =
      "Evidence against what all runs that explain the whole have; p: how probable something as far off is without that piece";
  table.head = {"evidence", "seen", "tolerance", "runs have (95 %)", "p", ""};
  for (std::size_t e = 0; e < fit.checks.size(); ++e) {
    const scenes::Evidence& seen = scene.inference.evidence[e];
    const Check& c = fit.checks[e];
    std::string value, predicted;
    for (std::size_t k = 0; k < seen.value.size(); ++k) {
      value +=
          (k ? ", " : "") + told(seen.value[k], k + 1 == seen.value.size() ? seen.unit : scenes::WrittenUnit{"", seen.unit.factor},
                                 seen.tolerance / 10);
      predicted += (k ? "; " : "") + value_in_words(c.predicted[k], seen.unit, seen.tolerance / 100);
    }
    const bool apart = c.p_value < kContradicts / static_cast<double>(fit.checks.size());
    table.rows.push_back({seen.name, value, told(seen.tolerance, seen.unit, seen.tolerance / 10), predicted,
                          c.p_value < 0.001 ? "< 0.001" : fmt::format("{:.3f}", c.p_value), apart ? "CONTRADICTS" : ""});
    if (apart) table.emphasised = static_cast<int>(e);
  }
  return table;
}

}  // namespace

render::charts::Page fit_page(const scenes::Scene& scene, const Prior& prior, const Fit& fit, const std::vector<ButFor>& but_for) {
  charts::Page page;
  page.title = (fit.reasons.empty() ? "Which inputs explain the evidence: " : "No single number: ") + heading_of(scene);
  page.subtitle =
      "Simulation against evidence (crashreel fit). Intervals hold the truth with the probability stated, if the assumptions hold.";
  page.footer = fmt::format("crashreel {} | {} | scene SHA-256 {} | {} runs, seed {}", CRASHREEL_VERSION,
                            scene.path.filename().string(), scene.sha256.substr(0, 16), fit.table.rows.size(), fit.seed);
  page.findings = sentences(scene, prior, fit, but_for);
  for (std::size_t i = 0; i < std::min(kMostInputs, fit.values.size()); ++i) {
    const scenes::Uncertain& u = prior.inputs()[i];
    page.grid.push_back(u.spread == scenes::Spread::choice ? choice_chart(u, i, fit) : density_chart(u, i, fit));
  }
  if (fit.values.size() > 1) page.grid.push_back(joint_chart(prior, fit));
  page.grid.push_back(residuals(scene, fit));
  if (fit.checks.size() > 1 && prior.inputs().front().spread != scenes::Spread::choice) page.bars = leave_one_out(prior, fit, 0);
  page.table = evidence_table(scene, fit);
  return page;
}

}  // namespace cli::inference
