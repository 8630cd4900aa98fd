#include "cli/study/output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/output/json.h"
#include "cli/scene_run.h"
#include "cli/study/words.h"

namespace cli::study {
namespace {

std::string quoted(const std::string& text) {
  return text.find(',') == std::string::npos ? text : "\"" + text + "\"";
}

/// Empty where there is none: a number in words would break a script.
std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

double step_of(const SeriesResult& series, const SettingResult& result) {
  if (series.series.varies == "step") return result.setting.fineness;
  return result.end_s > 0 && result.steps > 0 ? result.end_s / static_cast<double>(result.steps) : 0;
}

Json setting_json(const SeriesResult& series, const SettingResult& result, const std::string& letter) {
  Json out = {{"setting", result.setting.label},   {"overrides", result.setting.overrides},
              {"own", result.setting.own},         {"step_s", step_of(series, result)},
              {"wall_s", result.wall_s},           {"wall_quartiles_s", {result.wall_low, result.wall_high}},
              {"repetitions", result.repetitions}, {"steps", result.steps},
              {"contact_sequence", letter}};
  if (result.instructions > 0) out["instructions"] = result.instructions;
  if (!result.recording.empty()) out["recording"] = result.recording;
  if (!result.failure.empty()) out["failure"] = result.failure;
  for (const auto& [name, a] : result.answers)
    out["answers"][name] = {
        {"value", number_json(a.value)},   {"error", number_json(a.error)}, {"uncertainty", number_json(a.uncertainty)},
        {"median", number_json(a.middle)}, {"p5", number_json(a.low)},      {"p95", number_json(a.high)}};
  return out;
}

Json judgement_json(const Judgement& j) {
  const Convergence& c = j.convergence;
  return {{"quantity", j.quantity},
          {"reference", number_json(j.reference)},
          {"error_kind", j.error_kind},
          {"trust", name_of(c.trust)},
          {"order", number_json(c.order)},
          {"limit", number_json(c.limit)},
          {"estimated_errors", c.error},
          {"bands", c.band},
          {"besides_the_step", j.beside_the_step()},
          {"cloud", j.cloud},
          {"second_scheme", j.second_scheme.empty() ? Json(nullptr) : Json(j.second_scheme)},
          {"schemes_agree", j.second_scheme.empty() ? Json(nullptr) : Json(j.schemes_agree)}};
}

/// What each range of --input does to each measure.
std::string inputs_text(const Study& study, std::size_t widest) {
  if (study.inputs.empty()) return "";
  std::string out = "  ranges given with --input, and half of what both ends and the scene's own value span:\n";
  for (const InputRange& input : study.inputs) {
    out += fmt::format("  {} from {} to {}\n", input.key, input.low, input.high);
    for (const auto& [quantity, half_width] : input.half_width)
      if (!is_defect(quantity))
        out += fmt::format("    {:<{}} {:>12.3g}{}\n", quantity, widest, half_width,
                           input.turns.contains(quantity) ? "  at least: not monotonic, it turns within the range" : "");
  }
  return out;
}

}  // namespace

std::vector<std::string> sequence_letters(const SeriesResult& series) {
  std::vector<std::vector<std::string>> known;
  std::vector<std::string> out(series.settings.size());
  for (std::size_t i = series.settings.size(); i-- > 0;) {
    std::size_t k = 0;
    while (k < known.size() && known[k] != series.settings[i].contacts) ++k;
    if (k == known.size()) known.push_back(series.settings[i].contacts);
    out[i] = k < 26 ? std::string(1, static_cast<char>('A' + k)) : fmt::format("{}", k);
  }
  return out;
}

std::string study_csv(const Study& study) {
  std::string out =
      "series,setting,step_s,quantity,value,error,error_kind,wall_s,steps_per_s,order,uncertainty,median,p5,p95,steps,instructions,"
      "contact_sequence\n";
  for (std::size_t s = 0; s < study.series.size(); ++s) {
    const SeriesResult& series = study.series[s];
    const std::vector<std::string> letters = sequence_letters(series);
    for (std::size_t i = 0; i < series.settings.size(); ++i) {
      const SettingResult& r = series.settings[i];
      for (const Judgement& j : study.judgements) {
        const auto found = r.answers.find(j.quantity);
        if (found == r.answers.end()) continue;
        const Answer& a = found->second;
        out +=
            fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", quoted(series.series.name), quoted(r.setting.label),
                        number(step_of(series, r)), quoted(j.quantity), number(a.value), number(a.error), j.error_kind,
                        number(r.wall_s), number(r.wall_s > 0 ? static_cast<double>(r.steps) / r.wall_s : NAN),
                        s == 0 ? number(j.convergence.order) : "", number(a.uncertainty), number(a.middle), number(a.low),
                        number(a.high), r.steps, r.instructions > 0 ? number(r.instructions) : "", letters[i]);
      }
    }
  }
  return out;
}

nlohmann::ordered_json study_json(const scenes::Scene& scene, const Study& study) {
  Json out;
  out["schema"] = 1;
  out["version"] = CRASHREEL_VERSION;
  out["scene"] = {{"title", scene.title}, {"path", scene.path.string()}, {"sha256", scene.sha256}, {"overrides", scene.overrides}};
  out["main_quantity"] = main_quantity(study);
  out["findings"] = Json::array();
  if (const Judgement* j = study.find(main_quantity(study))) out["findings"] = findings(study, *j);
  for (const Judgement& j : study.judgements) out["quantities"].push_back(judgement_json(j));
  for (const SeriesResult& series : study.series) {
    const std::vector<std::string> letters = sequence_letters(series);
    Json one = {{"series", series.series.name}, {"varies", series.series.varies}, {"meaning", series.series.meaning}};
    for (std::size_t i = 0; i < series.settings.size(); ++i)
      one["settings"].push_back(setting_json(series, series.settings[i], letters[i]));
    for (std::size_t i = 0; i < series.settings.size(); ++i) one["contact_sequences"][letters[i]] = series.settings[i].contacts;
    out["series"].push_back(one);
  }
  add_notices(study.notices, out);
  out["inputs"] = Json::array();
  for (const InputRange& input : study.inputs)
    out["inputs"].push_back({{"key", input.key},
                             {"low", input.low},
                             {"high", input.high},
                             {"half_width", input.half_width},
                             {"not_monotonic", input.turns}});
  return out;
}

std::string study_text(const scenes::Scene& scene, const Study& study) {
  std::string out = heading_of(scene) + "\n";
  const SettingResult* own = study.own();
  if (!own) return out;
  out += fmt::format("  at the scene's own settings ({}, {:.3g} s of computing):\n", own->setting.label, own->wall_s);
  std::size_t widest = 0;
  for (const Judgement& j : study.judgements) widest = std::max(widest, j.quantity.size());
  out += fmt::format("  {:<{}} {:>12} {:>12} {:>12} {:>8}  {}\n", "quantity", widest, "value", "numerical", "sensitivity", "order",
                     "reference");
  for (const Judgement& j : study.judgements) {
    const auto found = own->answers.find(j.quantity);
    if (found == own->answers.end()) continue;
    const Answer& a = found->second;
    out += fmt::format(
        "  {:<{}} {:>12.6g} {:>12.3g} {:>12.3g} {:>8}  {}\n", j.quantity, widest, a.value, a.uncertainty, (a.high - a.low) / 2,
        std::isfinite(j.convergence.order) ? fmt::format("{:.2f}", j.convergence.order) : name_of(j.convergence.trust),
        j.error_kind == "closed_form" ? fmt::format("closed form, error {:.3g}", a.error) : j.error_kind);
  }
  out += inputs_text(study, widest);
  for (const std::string& notice : in_words(study.notices)) out += "  " + notice + "\n";
  if (const Judgement* j = study.find(main_quantity(study))) {
    const std::vector<std::string> sentences = findings(study, *j);  // what time buys, what the answer hangs on, then more
    for (std::size_t i = 0; i < std::min<std::size_t>(2, sentences.size()); ++i)
      out += fmt::format("  {}: {}\n", words_of(j->quantity), sentences[i]);
  }
  return out;
}

}  // namespace cli::study
