#include "cli/study/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "cli/exit.h"
#include "cli/study/words.h"
#include "scenes/loader/value.h"

namespace cli::study {
namespace {

/// Size of a unit in that of a key.
constexpr std::pair<const char*, double> kUnits[] = {{"", 1},           {"m", 1},     {"cm", 0.01}, {"mm", 1e-3},
                                                     {"s", 1},          {"ms", 1e-3}, {"mps", 1},   {"m/s", 1},
                                                     {"km/h", 1 / 3.6}, {"deg", 1},   {"g", 1}};

bool fits(const std::string& quantity, const std::string& wish) {
  const std::string key = quantity.substr(0, quantity.find(' '));
  return quantity == wish || key == wish || key.substr(0, key.rfind('_')) == wish;
}

}  // namespace

Target parse_target(const std::string& text) {
  const std::size_t equals = text.find('=');
  Target out;
  const auto refuse = [&text]() {
    return UsageError(fmt::format("--target is \"{}\": must be a measure and its width, like throw_distance=0.05m", text));
  };
  if (equals == std::string::npos || equals == 0) throw refuse();
  out.quantity = text.substr(0, equals);
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + equals + 1, end, out.width);
  if (error != std::errc() || !(out.width > 0) || !std::isfinite(out.width)) throw refuse();
  std::string unit(rest, end);
  unit.erase(std::remove(unit.begin(), unit.end(), ' '), unit.end());
  const auto found = std::find_if(std::begin(kUnits), std::end(kUnits), [&unit](const auto& known) { return unit == known.first; });
  if (found == std::end(kUnits)) throw refuse();
  out.width *= found->second;
  return out;
}

std::string as_scene_lines(const std::vector<std::string>& overrides) {
  std::map<std::string, std::string> tables;
  for (const std::string& text : overrides) {
    const std::size_t equals = text.find('=');
    const std::size_t dot = text.rfind('.', equals);
    const std::string value = text.substr(equals + 1);
    const bool word = value == "true" || value == "false";
    tables[text.substr(0, dot)] +=
        fmt::format("{} = {}\n", text.substr(dot + 1, equals - dot - 1), word ? value : "\"" + value + "\"");
  }
  std::string out;
  for (const auto& [name, lines] : tables) out += fmt::format("[{}]\n{}", name, lines);
  return out;
}

void check_target(const Target& target, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (fits(name, target.quantity)) return;
  std::string near = scenes::nearest(target.quantity, names);
  std::set<std::string> keys;  // without whose they are
  for (const std::string& name : names) keys.insert(name.substr(0, name.find(' ')));
  // a part of a name, such as "throw"
  std::vector<std::string> longer;
  for (const std::string& key : keys)
    if (!target.quantity.empty() && key.starts_with(target.quantity + "_")) longer.push_back(key);
  if (!longer.empty()) near = fmt::format("{}", fmt::join(longer, " or "));
  throw UsageError(fmt::format("--target: the scene has no measure {}{} it has {}", target.quantity,
                               near.empty() ? ";" : fmt::format("; did you mean {}?", near), fmt::join(keys, ", ")));
}

TargetAnswer search(const Study& study, const Target& target) {
  const Judgement* judgement = nullptr;
  std::vector<std::string> names;
  for (const Judgement& j : study.judgements) {
    names.push_back(j.quantity);
    if (!judgement && fits(j.quantity, target.quantity)) judgement = &j;
  }
  if (!judgement)
    throw UsageError(fmt::format("--target: the scene has no measure {}; it has {}", target.quantity, fmt::join(names, ", ")));
  const std::string unit = unit_of(judgement->quantity);
  TargetAnswer out;
  const SettingResult* surest = nullptr;
  double spread = 0, best_wall = 0;
  for (const SeriesResult& series : study.series) {
    // another law; a matter of reading, or of the start, not of cost
    if (series.series.other_law || series.series.varies == "interval" || series.series.varies == kStartsVary) continue;
    for (const SettingResult& r : series.settings) {
      const auto found = r.answers.find(judgement->quantity);
      if (found == r.answers.end() || !r.failure.empty()) continue;
      if (r.setting.own) spread = (found->second.high - found->second.low) / 2;
      if (!surest || found->second.uncertainty < surest->answers.at(judgement->quantity).uncertainty) surest = &r;
      if (found->second.uncertainty > target.width || (out.setting && r.wall_s >= best_wall)) continue;
      out.setting = &r;
      best_wall = r.wall_s;
    }
  }
  if (!out.setting) {
    out.text = fmt::format("of no setting can the study show that it holds {} to {}", words_of(judgement->quantity),
                           with_unit(target.width, unit));
    if (surest)
      out.text += fmt::format("; surest is {}, {} of computing, numerical uncertainty {}", surest->setting.label,
                              with_unit(surest->wall_s, "s"), with_unit(surest->answers.at(judgement->quantity).uncertainty, unit));
    out.text += "\n";
  } else {
    out.text = fmt::format(
        "cheapest setting that holds {} to {}: {}, {} of computing, numerical uncertainty {}\n\n{}", words_of(judgement->quantity),
        with_unit(target.width, unit), out.setting->setting.label, with_unit(out.setting->wall_s, "s"),
        with_unit(out.setting->answers.at(judgement->quantity).uncertainty, unit), as_scene_lines(out.setting->setting.overrides));
  }
  if (spread > target.width)
    out.text +=
        fmt::format("\nbut minute changes of the scene move it by {}: that is no matter of the setting\n", with_unit(spread, unit));
  return out;
}

}  // namespace cli::study
