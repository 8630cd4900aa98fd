#include "cli/study/run.h"

#include <fmt/format.h>

#include <cmath>

#include "cli/exit.h"
#include "cli/output/whole_file.h"
#include "cli/study/pool.h"

namespace cli::study {
namespace {

/// The trials of one setting lie side by side: the plain run, then its members.
struct Batch {
  std::vector<Trial> trials;
  std::string program = program_hash();

  std::size_t add(const scenes::Scene& scene, const Setting& setting, double cost) {
    const std::size_t first = trials.size();
    const std::vector<std::string> overrides = runs_with(setting);
    for (int member = 0; member <= setting.members; ++member) {
      Trial trial{scene.path, scene.overrides, member, cost, ""};
      trial.overrides.insert(trial.overrides.end(), overrides.begin(), overrides.end());
      trial.fingerprint = fingerprint_of(trial, program);
      trials.push_back(std::move(trial));
    }
    return first;
  }
};

double cost_of(const scenes::Scene& scene, const Series& series, const Setting& setting) {
  const engine::Settings& s = scene.model.settings;
  const double steps = s.duration / s.step;
  return series.varies == "step" && setting.fineness > 0 ? steps * s.step / setting.fineness : steps;
}

InputRange parse_input(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t dots = text.find("..", equals == std::string::npos ? 0 : equals);
  if (equals == std::string::npos || equals == 0 || dots == std::string::npos)
    throw UsageError(fmt::format("--input is \"{}\", must be PATH=LOW..HIGH, like vehicle.car.speed=\"39 km/h..41 km/h\"", text));
  return {text.substr(0, equals), text.substr(equals + 1, dots - equals - 1), text.substr(dots + 2), {}};
}

bool accepted(const scenes::Scene& scene, const std::vector<std::string>& overrides) {
  std::vector<std::string> all = scene.overrides;
  all.insert(all.end(), overrides.begin(), overrides.end());
  try {
    scenes::load(scene.path, all);
    return true;
  } catch (const scenes::SceneErrors&) {
    return false;
  }
}

void fill_inputs(Study& study, const std::vector<std::pair<SettingResult, SettingResult>>& ends) {
  for (std::size_t i = 0; i < study.inputs.size(); ++i)
    for (const auto& [name, low] : ends[i].first.answers) {
      const auto high = ends[i].second.answers.find(name);
      if (high != ends[i].second.answers.end()) study.inputs[i].half_width[name] = std::abs(high->second.middle - low.middle) / 2;
    }
}

}  // namespace

Study run_study(const scenes::Scene& scene, const RunWish& wish) {
  const std::vector<Series> series =
      series_for(scene, wish.options, [&scene](const std::vector<std::string>& overrides) { return accepted(scene, overrides); });
  Study study;
  study.interval = study_interval(scene.model.settings);
  if (solver_decides(scene)) study.solver_tolerance = scene.model.settings.solver_tolerance;
  for (const std::string& input : wish.inputs) study.inputs.push_back(parse_input(input));

  Batch batch;
  for (const Series& s : series)
    for (const Setting& setting : s.settings) batch.add(scene, setting, cost_of(scene, s, setting));
  std::vector<Setting> ends;
  for (const InputRange& input : study.inputs)
    for (const std::string& end : {input.low, input.high})
      ends.push_back({input.key + " " + end, {input.key + "=" + end}, {}, 0, std::min(4, wish.options.members), false});
  for (const Setting& end : ends) batch.add(scene, end, scene.model.settings.duration / scene.model.settings.step);

  make_writable_folder(wish.folder / "runs");
  const std::vector<Outcome> outcomes = run_all(batch.trials, wish.folder / "runs", wish.jobs, wish.show);

  std::size_t next = 0;
  const auto take = [&](const Setting& setting) {
    const auto begin = outcomes.begin() + static_cast<std::ptrdiff_t>(next);
    next += static_cast<std::size_t>(setting.members) + 1;
    return summarise(setting, {begin, outcomes.begin() + static_cast<std::ptrdiff_t>(next)});
  };
  for (const Series& s : series) {
    study.series.push_back({s, {}});
    for (const Setting& setting : s.settings) study.series.back().settings.push_back(take(setting));
  }
  std::vector<std::pair<SettingResult, SettingResult>> input_results;
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
    SettingResult low = take(ends[i]);
    input_results.emplace_back(std::move(low), take(ends[i + 1]));
  }
  fill_inputs(study, input_results);
  judge(study, scene.closed_form);
  return study;
}

}  // namespace cli::study
