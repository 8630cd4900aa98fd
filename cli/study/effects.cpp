#include "cli/study/effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/output/json.h"
#include "cli/scene_run.h"
#include "cli/study/words.h"
#include "engine/plan.h"

namespace cli::study {
namespace {

namespace charts = render::charts;

double value_of(const SettingResult& result, const std::string& quantity) {
  const Answer* a = answer_of(result, quantity);
  return a ? a->value : NAN;
}

std::string change_in_words(const EffectsStudy& study, const EffectOff& off, const std::string& quantity) {
  const auto found = off.change.find(quantity);
  if (!off.result.failure.empty()) return "diverged";
  if (found == off.change.end()) return answer_of(off.result, quantity) ? "new" : "gone";
  if (found->second == 0) return "none";
  const std::string text = (found->second > 0 ? "+" : "") + with_unit(found->second, unit_of(quantity));
  return std::abs(found->second) <= study.spread(quantity) ? "(" + text + ")" : text;
}

charts::Bars bars_of(const EffectsStudy& study, const std::string& quantity) {
  charts::Bars bars;
  bars.title = fmt::format("Change of the {} when an effect is left out", words_of(quantity));
  bars.parts = {"change"};
  for (const EffectOff& off : study.off) {
    const auto found = off.change.find(quantity);
    bars.rows.push_back(
        {off.effect, {found == off.change.end() ? 0 : std::abs(found->second)}, {change_in_words(study, off, quantity)}});
  }
  return bars;
}

charts::Bars savings(const EffectsStudy& study) {
  charts::Bars bars;
  bars.title = "Computing time of the run without it";
  bars.parts = {"time", "saved"};
  for (const EffectOff& off : study.off) {
    const double share = study.all.wall_s > 0 ? off.saved_s / study.all.wall_s : 0;
    bars.rows.push_back({off.effect,
                         {off.result.wall_s, std::max(0.0, off.saved_s)},
                         {with_unit(off.result.wall_s, "s"), fmt::format("{:.0f} %", 100 * share)}});
  }
  return bars;
}

charts::Table table_of(const EffectsStudy& study) {
  // as many measures as a line holds; the files have all
  std::vector<std::string> shown = study.quantities;
  std::erase_if(shown, [&](const std::string& q) { return is_defect(q); });
  constexpr std::size_t kMost = 8;
  if (shown.size() > kMost) shown.resize(kMost);
  charts::Table table;
  table.title = "Change of each measure when the effect is left out";
  table.head = {"left out"};
  for (const std::string& q : shown) table.head.push_back(words_of(q));
  std::vector<std::string> values = {"none (value)"};
  for (const std::string& q : shown) values.push_back(with_unit(value_of(study.all, q), unit_of(q)));
  table.rows.push_back(values);
  table.emphasised = 0;
  for (const EffectOff& off : study.off) {
    std::vector<std::string> row = {off.effect};
    for (const std::string& q : shown) row.push_back(change_in_words(study, off, q));
    table.rows.push_back(row);
  }
  table.note =
      "In brackets: no more than minute changes of the scene do. \"gone\": the run without it no longer defines the measure. An "
      "effect whose absence changes nothing here may matter in another scene; none is left out unless the scene's author says so.";
  return table;
}

}  // namespace

double EffectsStudy::spread(const std::string& quantity) const {
  const Answer* a = answer_of(all, quantity);
  return a ? (a->high - a->low) / 2 : 0;
}

EffectsStudy study_effects(const scenes::Scene& scene, const RunWish& wish) {
  const engine::Plan plan = engine::compile(scene.model);
  EffectsStudy study;
  std::vector<Setting> settings = {{"as it stands", {}, 0, wish.options.members, true}};
  for (const engine::PlanLine& line : plan.lines) {
    if (!line.active) continue;
    study.off.push_back({line.effect, line.reason, {}, {}, 0});
    settings.push_back({"without " + line.effect, {fmt::format("simulation.effects.{}=off", line.effect)}, 0, 0, false});
  }
  std::vector<SettingResult> results = run_settings(scene, settings, wish);
  study.all = std::move(results.front());
  for (std::size_t i = 0; i < study.off.size(); ++i) {
    EffectOff& off = study.off[i];
    off.result = std::move(results[i + 1]);
    off.saved_s = study.all.wall_s - off.result.wall_s;
    for (const auto& [name, answer] : study.all.answers)
      if (const Answer* without = answer_of(off.result, name)) off.change[name] = without->value - answer.value;
  }
  for (const auto& [name, answer] : study.all.answers) study.quantities.push_back(name);
  std::stable_partition(study.quantities.begin(), study.quantities.end(), [](const std::string& q) { return !is_defect(q); });
  const std::string main = main_of(study.quantities);
  std::stable_partition(study.quantities.begin(), study.quantities.end(), [&main](const std::string& q) { return q == main; });
  return study;
}

std::string effects_csv(const EffectsStudy& study) {
  std::string out = "effect,quantity,value,without,change,spread,wall_s,saved_s,failure\n";
  const auto number = [](double value) { return std::isfinite(value) ? fmt::format("{}", value) : std::string(); };
  for (const EffectOff& off : study.off)
    for (const std::string& q : study.quantities) {
      const auto change = off.change.find(q);
      out += fmt::format("{},{},{},{},{},{},{},{},{}\n", off.effect, q, number(value_of(study.all, q)),
                         number(value_of(off.result, q)), change == off.change.end() ? "" : number(change->second),
                         number(study.spread(q)), number(off.result.wall_s), number(off.saved_s),
                         off.result.failure.empty() ? "" : "diverged");
    }
  return out;
}

Json effects_json(const scenes::Scene& scene, const EffectsStudy& study) {
  Json out = {{"schema", 1}, {"version", CRASHREEL_VERSION}};
  out["scene"] = {{"title", scene.title}, {"path", scene.path.string()}, {"sha256", scene.sha256}, {"overrides", scene.overrides}};
  out["wall_s"] = study.all.wall_s;
  for (const std::string& q : study.quantities)
    out["quantities"].push_back({{"quantity", q}, {"value", value_of(study.all, q)}, {"spread", study.spread(q)}});
  for (const EffectOff& off : study.off) {
    Json one = {{"effect", off.effect}, {"reason", off.reason}, {"wall_s", off.result.wall_s}, {"saved_s", off.saved_s}};
    if (!off.result.failure.empty()) one["failure"] = off.result.failure;
    one["change"] = off.change;
    out["effects"].push_back(one);
  }
  return out;
}

std::string effects_text(const scenes::Scene& scene, const EffectsStudy& study) {
  std::string out = fmt::format("{}\n  all effects: {:.3g} s of computing\n", heading_of(scene), study.all.wall_s);
  const std::string main = study.quantities.empty() ? "" : study.quantities.front();
  out += fmt::format("  {:<24} {:>20} {:>12}\n", "left out", "change of " + words_of(main), "time saved");
  for (const EffectOff& off : study.off)
    out += fmt::format("  {:<24} {:>20} {:>12}\n", off.effect, change_in_words(study, off, main), with_unit(off.saved_s, "s"));
  return out;
}

charts::Page effects_page(const scenes::Scene& scene, const EffectsStudy& study) {
  charts::Page page;
  page.subtitle = heading_of(scene);
  page.footer = provenance_of(scene);
  const std::string main = study.quantities.empty() ? "" : study.quantities.front();
  if (main.empty() || study.off.empty()) {
    page.title = "This scene has no effect to leave out";
    return page;
  }
  const auto strongest = std::max_element(study.off.begin(), study.off.end(), [&](const EffectOff& a, const EffectOff& b) {
    const auto size = [&](const EffectOff& off) {
      const auto found = off.change.find(main);
      return found == off.change.end() ? 0.0 : std::abs(found->second);
    };
    return size(a) < size(b);
  });
  const auto idle = std::count_if(study.off.begin(), study.off.end(), [&](const EffectOff& off) {
    const auto found = off.change.find(main);
    return found != off.change.end() && std::abs(found->second) <= study.spread(main) && off.result.failure.empty();
  });
  page.title = fmt::format("What each physical effect does: without {} the {} changes by {}", strongest->effect, words_of(main),
                           change_in_words(study, *strongest, main));
  const std::string minute =
      fmt::format("changes too small to be measured do (\u00b1 {})", with_unit(study.spread(main), unit_of(main)));
  page.findings = {
      fmt::format("The plan of this scene has {} effects, each left out in turn. {} the {} by {} {}.", study.off.size(),
                  idle == 0   ? "Every one changes"
                  : idle == 1 ? "One of them changes"
                              : fmt::format("{} of them change", idle),
                  words_of(main), idle == 0 ? "more than" : "no more than", minute),
      "A run that leaves out what the scene calls for is no reconstruction: it shows what the effect is there for."};
  page.upper_left = bars_of(study, main);
  page.upper_right = savings(study);
  page.table = table_of(study);
  return page;
}

}  // namespace cli::study
