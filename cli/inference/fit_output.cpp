// A fit as JSON, as a table, and in sentences.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/inference/fit.h"
#include "cli/inference/sample.h"
#include "cli/output/json.h"
#include "cli/study/quantities.h"

namespace cli::inference {
namespace {

/// Nothing in place of numbers that may not be given.
Json interval_json(const Interval& i, bool given) {
  const auto number = [&](double x) { return given ? number_json(x) : Json(nullptr); };
  return {{"mean", number(i.mean)},
          {"sd", number(i.sd)},
          {"p2_5", number(i.low)},
          {"median", number(i.median)},
          {"p97_5", number(i.high)}};
}

Json input_json(const scenes::Uncertain& u, std::size_t i, const Fit& fit) {
  if (u.spread == scenes::Spread::choice) {
    Json out = {{"unit", ""}, {"probabilities", Json::object()}};
    for (std::size_t c = 0; c < u.choices.size(); ++c) {
      double share = 0;
      for (std::size_t r = 0; r < fit.table.rows.size(); ++r)
        if (static_cast<std::size_t>(fit.values[i][r]) == c) share += fit.posterior.weights[r];
      out["probabilities"][u.choices[c]] = share;
    }
    return out;
  }
  Json out = {{"unit", u.si_unit}};
  out.update(interval_json(fit.inputs[i], fit.reasons.empty()));
  out["prior"] = in_words(u);
  out["modes"] = Json::array();
  for (const Mode& m : fit.modes[i])
    out["modes"].push_back({{"from", m.low}, {"to", m.high}, {"peak", m.peak}, {"share", m.share}});
  return out;
}

Json check_json(const Prior& prior, const scenes::Evidence& e, const Check& c) {
  Json out = {{"name", e.name}, {"observed", e.value}, {"tolerance", e.tolerance}};
  if (e.value.size() == 1) out["observed"] = e.value[0];
  Json predicted = Json::array();
  for (const Interval& i : c.predicted)
    predicted.push_back({{"mean", number_json(i.mean)}, {"p2_5", number_json(i.low)}, {"p97_5", number_json(i.high)}});
  out["predicted"] = predicted.size() == 1 ? predicted[0] : predicted;
  out["missing"] = c.missing;
  out["p_value"] = c.p_value;
  out["nearest_misfit"] = number_json(c.nearest);
  out["removed"] = {{"effective_samples", c.effective}, {"inputs", Json::object()}};
  for (std::size_t i = 0; i < c.removed.size(); ++i)
    out["removed"]["inputs"][prior.inputs()[i].key] = interval_json(c.removed[i], c.effective >= kEnoughRuns);
  return out;
}

Json but_for_json(const ButFor& b) {
  if (!b.unanswered.empty()) return {{"set", b.change}, {"unanswered", b.unanswered}};
  Json out = {{"set", b.change}, {"runs", b.runs}, {"failed", b.failed}, {"met", b.met_before}, {"met_after", b.met_after}};
  if (b.met_before > 0) out["no_contact"] = {{"probability", b.avoided}, {"p2_5", b.low}, {"p97_5", b.high}};
  for (const ButFor::Severity& s : b.severities)
    out["severity"][s.name] = {{"before", interval_json(s.before, true)}, {"after", interval_json(s.after, true)}};
  return out;
}

Json calibration_json(const Calibration& c) {
  return {{"key", c.key},
          {"cases", c.cases},
          {"inside_90", c.inside_90},
          {"ranks", c.ranks},
          {"chi_squared", c.chi_squared},
          {"median_effective_samples", c.median_effective}};
}

/// "48.1 to 51.9 mph", with the digits the width allows.
std::string range_in_words(double low, double high, const scenes::WrittenUnit& unit) {
  const double fine = (high - low) / 4;  // no digits the width does not carry
  return fmt::format("{} to {}", told(low, {"", unit.factor}, fine), told(high, unit, fine));
}

std::string answer_in_words(const scenes::Uncertain& u, std::size_t i, const Fit& fit) {
  constexpr double kNarrower = 0.9;  // of the range beforehand: what is wider was assumed rather than found
  const Interval& v = fit.inputs[i];
  const bool found = v.high - v.low < kNarrower * (quantile(u, 0.975) - quantile(u, 0.025));
  return fmt::format("{} {} (95 %), as probably above as below {}{}", u.key, range_in_words(v.low, v.high, u.unit),
                     told(v.median, u.unit, (v.high - v.low) / 4),
                     found ? "" : "; so it was assumed, the evidence hardly narrows it");
}

void add_modes(const Prior& prior, const Fit& fit, std::vector<std::string>& out) {
  for (std::size_t i = 0; i < fit.modes.size(); ++i) {
    if (fit.modes[i].size() < 2) continue;
    std::string line;
    for (const Mode& m : fit.modes[i])
      line += fmt::format("{}{} ({:.0f} %)", line.empty() ? "" : ", or ", range_in_words(m.low, m.high, prior.inputs()[i].unit),
                          100 * m.share);
    out.push_back(fmt::format("{}: {}.", prior.inputs()[i].key, line));
  }
}

/// "11.7 m (10.2 to 13.4)", with the digits the width allows; of a measure that hardly varies, three.
std::string middle_and_range(const Interval& v, const scenes::WrittenUnit& unit) {
  const double fine = std::max((v.high - v.low) / 8, 1e-2 * std::abs(v.median));
  return fmt::format("{} ({} to {})", told(v.median, unit, fine), told(v.low, {}, fine), told(v.high, {}, fine));
}

void add_but_for(const std::vector<ButFor>& all, std::vector<std::string>& out) {
  for (const ButFor& b : all) {
    std::string line = fmt::format("With {}: ", b.change);
    if (!b.unanswered.empty())
      line += "not answered, " + b.unanswered;
    else if (b.met_before == 0)
      line += "nobody was met to begin with";
    else
      line += fmt::format("the contact would not have occurred in {:.0f} % ({:.0f} to {:.0f}) of {} equally probable runs",
                          100 * b.avoided, 100 * b.low, 100 * b.high, b.met_before);
    for (const ButFor::Severity& s : b.severities) {
      const scenes::WrittenUnit unit{study::unit_of(s.name), 1};
      if (std::isfinite(s.before.median)) line += fmt::format("; {} {}", study::words_of(s.name), middle_and_range(s.before, unit));
      if (std::isfinite(s.after.median)) line += fmt::format(" would be {}", middle_and_range(s.after, unit));
    }
    if (b.failed > 0) line += fmt::format("; {} runs gave no answer", b.failed);
    out.push_back(line + ".");
  }
}

}  // namespace

std::vector<std::string> sentences(const scenes::Scene& scene, const Prior& prior, const Fit& fit,
                                   const std::vector<ButFor>& but_for) {
  std::vector<std::string> out;
  if (fit.reasons.empty()) {
    for (std::size_t i = 0; i < fit.inputs.size(); ++i)
      if (prior.inputs()[i].spread != scenes::Spread::choice)
        out.push_back("If the assumptions below hold: " + answer_in_words(prior.inputs()[i], i, fit) + ".");
  } else {
    for (const std::string& reason : fit.reasons) out.push_back("No single number can be given: " + reason + ".");
    if (fit.posterior.effective >= kEnoughRuns) add_modes(prior, fit, out);
  }
  add_but_for(but_for, out);
  std::string assumed, seen;
  for (const auto& u : prior.inputs()) assumed += fmt::format("{}{} {}", assumed.empty() ? "" : "; ", u.key, in_words(u));
  for (const auto& e : scene.inference.evidence) seen += fmt::format("{}{}", seen.empty() ? "" : ", ", e.name);
  out.push_back(
      fmt::format("Assumed: the model as the scene has it; evidence {}{}, errors normal with its tolerance as standard deviation; "
                  "beforehand {}.",
                  seen, scene.inference.evidence.size() > 1 ? " independent" : "", assumed));
  int failed = 0;
  for (const auto& [reason, count] : fit.failures) failed += count;
  for (std::string& notice : in_words(notices_of(fit.table))) out.push_back(std::move(notice));
  out.push_back(fmt::format("{} runs, of which {:.0f} effective; {} gave no answer and count as not explaining the evidence{}.",
                            fit.table.rows.size(), fit.posterior.effective, failed,
                            failed > 0 ? " (commonest reason: " + fit.failures.front().first + ")" : ""));
  return out;
}

nlohmann::ordered_json fit_json(const scenes::Scene& scene, const Prior& prior, const Fit& fit, const std::vector<ButFor>& but_for,
                                const std::vector<Calibration>& calibrations) {
  Json out = {{"schema", 1}, {"version", CRASHREEL_VERSION}};
  out["scene"] = {{"title", scene.title}, {"path", scene.path.string()}, {"sha256", scene.sha256}, {"overrides", scene.overrides}};
  out["seed"] = fit.seed;
  out["single_number"] = fit.reasons.empty();
  out["reasons"] = fit.reasons;
  out["inputs"] = Json::object();
  for (std::size_t i = 0; i < prior.inputs().size(); ++i)
    out["inputs"][prior.inputs()[i].key] = input_json(prior.inputs()[i], i, fit);
  out["correlation"] = Json::array();
  for (std::size_t i = 0; i < fit.values.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      out["correlation"].push_back({{"a", prior.inputs()[k].key},
                                    {"b", prior.inputs()[i].key},
                                    {"value", correlation_of(fit.values[i], fit.values[k], fit.posterior.weights)}});
  out["evidence"] = Json::array();
  for (std::size_t e = 0; e < fit.checks.size(); ++e)
    out["evidence"].push_back(check_json(prior, scene.inference.evidence[e], fit.checks[e]));
  out["contradiction"] = fit.contradiction;
  out["effective_samples"] = fit.posterior.effective;
  out["runs"] = fit.table.rows.size();
  out["failed"] = Json::array();
  for (const auto& [reason, count] : fit.failures) out["failed"].push_back({{"reason", reason}, {"runs", count}});
  add_notices(notices_of(fit.table), out);
  out["best"] = {{"misfit", number_json(fit.best_misfit)}, {"p_value", fit.best_p}, {"run", fit.best + 1}, {"file", "best.toml"}};
  if (!but_for.empty()) {
    out["but_for"] = Json::array();
    for (const ButFor& b : but_for) out["but_for"].push_back(but_for_json(b));
  }
  if (!calibrations.empty()) {
    out["calibration"] = Json::array();
    for (const Calibration& c : calibrations) out["calibration"].push_back(calibration_json(c));
  }
  return out;
}

std::string posterior_csv(const Prior& prior, const std::vector<scenes::Evidence>& evidence, const Fit& fit) {
  // the table of runs with the weight of each: a script needs no more to reckon anything from the posterior
  const std::string runs = runs_csv(prior, evidence, fit.table);
  std::string out;
  std::size_t begin = 0;
  for (std::size_t row = 0; begin < runs.size(); ++row) {
    const std::size_t end = runs.find('\n', begin);
    const std::string line = runs.substr(begin, end - begin);
    const std::size_t comma = line.find(',');
    out += line.substr(0, comma) + "," + (row == 0 ? "weight" : fmt::format("{}", fit.posterior.weights[row - 1])) +
           line.substr(comma) + "\n";
    begin = end + 1;
  }
  return out;
}

}  // namespace cli::inference
