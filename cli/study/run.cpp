#include "cli/study/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cli/build_id.h"
#include "cli/exit.h"
#include "cli/output/whole_file.h"
#include "cli/study/pool.h"
#include "engine/measure/definitions.h"
#include "scenes/loader/uncertain.h"

namespace cli::study {
namespace {

constexpr double kTurn = 1e-6;  // of an answer: what lies outside by less is the arithmetic's

/// The trials of one setting lie side by side: the plain run, then its members.
struct Batch {
  std::vector<Trial> trials;
  bool timed = true;
  std::string program = build_id();

  void add(const scenes::Scene& scene, const Setting& setting, double cost) {
    const scenes::Scene loaded = scenes::variant(scene, setting.overrides);
    for (int member = 0; member <= setting.members; ++member) {
      Trial trial{scene.file,           loaded.overrides, setting.start > 0 ? -setting.start : member, cost, timed, "",
                  loaded.assets_sha256, scene.meshes};
      trial.fingerprint = fingerprint_of(trial, loaded, program);
      trials.push_back(std::move(trial));
    }
  }
};

/// What came of the settings, in the order in which they were added.
class Results {
 public:
  explicit Results(std::vector<Outcome> outcomes) : outcomes_(std::move(outcomes)) {}
  Notices notices() const {
    Notices out;
    for (const Outcome& outcome : outcomes_) {
      RunNotes notes;
      for (const Quantity& q : outcome.quantities)
        if (q.so_far) notes.so_far.push_back(q.name);
      out.add(notes);
    }
    return out;
  }
  SettingResult take(const Setting& setting) {
    const auto begin = outcomes_.begin() + static_cast<std::ptrdiff_t>(next_);
    next_ += static_cast<std::size_t>(setting.members) + 1;
    return summarise(setting, {begin, outcomes_.begin() + static_cast<std::ptrdiff_t>(next_)});
  }

 private:
  std::vector<Outcome> outcomes_;
  std::size_t next_ = 0;
};

std::vector<Outcome> run_batch(const Batch& batch, const RunWish& wish) {
  make_writable_folder(wish.folder / "runs");
  return run_all(batch.trials, wish.folder / "runs", wish.jobs, wish.show);
}

double cost_of(const scenes::Scene& scene, const Series& series, const Setting& setting) {
  const engine::Settings& s = scene.model.settings;
  const double steps = s.duration / s.step;
  return series.varies == "step" && setting.fineness > 0 ? steps * s.step / setting.fineness : steps;
}

InputRange parse_input(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t dots = text.find("..", equals == std::string::npos ? 0 : equals);
  if (equals == std::string::npos || equals == 0 || dots == std::string::npos)
    throw UsageError(fmt::format("--input is \"{}\": must be PATH=LOW..HIGH, like vehicle.car.speed=\"39 km/h..41 km/h\"", text));
  return {text.substr(0, equals), text.substr(equals + 1, dots - equals - 1), text.substr(dots + 2), {}, {}};
}

bool accepted(const scenes::Scene& scene, const std::vector<std::string>& overrides) {
  try {
    scenes::variant(scene, overrides);
    return true;
  } catch (const scenes::SceneErrors&) {
    return false;
  }
}

/// The formula's answer is that of the scene as its file has it. Only what changes how it is computed leaves it true.
bool holds_closed_form(const scenes::Scene& scene) {
  constexpr const char* kHarmless[] = {
      "step",           "record_interval",   "scheme",        "adaptive_tolerance", "solver_tolerance",
      "touch_distance", "contacts_per_pair", "locate_events", "stop_at_rest"};
  return std::all_of(scene.overrides.begin(), scene.overrides.end(), [&](const std::string& text) {
    if (text.starts_with("closed_form.")) return true;
    const std::string key = text.substr(0, text.find('='));
    return std::any_of(std::begin(kHarmless), std::end(kHarmless),
                       [&](const char* harmless) { return key == std::string("simulation.") + harmless; });
  });
}

/// Two ends alone would miss a measure that turns between them: the scene's own answer lies there too.
void fill_inputs(Study& study, const std::vector<std::pair<SettingResult, SettingResult>>& ends) {
  const SettingResult* scene = study.own();
  for (std::size_t i = 0; i < study.inputs.size(); ++i)
    for (const auto& [name, first] : ends[i].first.answers) {
      const Answer *second = answer_of(ends[i].second, name), *own = scene ? answer_of(*scene, name) : nullptr;
      if (!second || !ends[i].first.failure.empty()) continue;
      const auto near = [&name = name, &first = first, own](double value) {
        return engine::turned_to(name, value, own ? own->middle : first.middle);
      };
      const auto [low_end, high_end] = std::minmax({near(first.middle), near(second->middle)});
      double low = low_end, high = high_end;
      if (own) {
        // no more than minute changes do is no turn
        const double spread = own->high - own->low, least = kTurn * std::abs(own->middle);
        if (std::max(low - own->middle, own->middle - high) > spread + least) study.inputs[i].turns.insert(name);
        low = std::min(low, own->middle);
        high = std::max(high, own->middle);
      }
      study.inputs[i].half_width[name] = (high - low) / 2;
    }
}

/// The number at a key of the scene, or what an override would make it.
std::optional<double> number_of(const scenes::Scene& scene, const std::string& key, const std::string& override_with = "") {
  scenes::Value root = scenes::parse_text(scene.file.text, scene.path.string());
  for (const std::string& text : scene.overrides) scenes::apply_override(root, text);
  if (!override_with.empty()) scenes::apply_override(root, key + "=" + override_with);
  return scenes::number_at(root, key);
}

/// A range rises and holds what the scene has: else half its width would say nothing of the scene's answer.
void refuse_odd_range(const scenes::Scene& scene, const std::string& text, const InputRange& range) {
  const auto refuse = [&text](const std::string& what) { throw UsageError(fmt::format("--input {}: {}", text, what)); };
  const std::optional<double> low = number_of(scene, range.key, range.low), high = number_of(scene, range.key, range.high);
  if (range.low == range.high || (low && high && *low == *high)) refuse("the range is a single value; give two that differ");
  if (!low || !high) return;
  if (*low > *high) refuse(fmt::format("the range falls; write the lower end first: {}={}..{}", range.key, range.high, range.low));
  const std::optional<double> own = number_of(scene, range.key);
  const double rounding = 1e-9 * std::max(std::abs(*low), std::abs(*high));  // of units
  if (!own || (*own >= *low - rounding && *own <= *high + rounding)) return;
  const std::string unit = scenes::unit_of_key(scenes::parse_text(scene.file.text, scene.path.string()), range.key).si_unit;
  refuse(fmt::format("the range does not hold the scene's own value, {:.6g}{}{}; widen it, or set another value with --set", *own,
                     unit.empty() ? "" : " ", unit));
}

/// The loader's complaint of `key=value`, without the words of the override it was given as.
std::string complaint(const scenes::SceneErrors& errors) {
  return errors.findings.front().what;
}

}  // namespace

void check_inputs(const scenes::Scene& scene, const std::vector<std::string>& inputs) {
  for (const std::string& text : inputs) {
    const InputRange range = parse_input(text);
    for (const std::string& end : {range.low, range.high}) {
      try {
        scenes::variant(scene, {range.key + "=" + end});
      } catch (const scenes::SceneErrors& errors) {
        throw UsageError(fmt::format("--input {}: {}", text, complaint(errors)));
      }
    }
    refuse_odd_range(scene, text, range);
  }
}

std::vector<SettingResult> run_settings(const scenes::Scene& scene, const std::vector<Setting>& settings, const RunWish& wish) {
  Batch batch;
  batch.timed = wish.timed;
  for (const Setting& setting : settings) batch.add(scene, setting, 1);
  Results results(run_batch(batch, wish));
  std::vector<SettingResult> out;
  for (const Setting& setting : settings) out.push_back(results.take(setting));
  return out;
}

Study run_study(const scenes::Scene& scene, const RunWish& wish) {
  const std::vector<Series> series =
      series_for(scene, wish.options, [&scene](const std::vector<std::string>& overrides) { return accepted(scene, overrides); });
  Study study;
  study.rigid_contacts = solver_decides(scene);
  study.interval = scene.model.settings.record_interval;
  for (const std::string& input : wish.inputs) study.inputs.push_back(parse_input(input));

  Batch batch;
  batch.timed = wish.timed;
  for (const Series& s : series)
    for (const Setting& setting : s.settings) batch.add(scene, setting, cost_of(scene, s, setting));
  std::vector<Setting> ends;
  for (const InputRange& input : study.inputs)
    for (const std::string& end : {input.low, input.high})
      ends.push_back({input.key + " " + end, {input.key + "=" + end}, 0, std::min(4, wish.options.members), false});
  for (const Setting& end : ends) batch.add(scene, end, scene.model.settings.duration / scene.model.settings.step);

  Results results(run_batch(batch, wish));
  study.notices = results.notices();
  for (const Series& s : series) {
    study.series.push_back({s, {}});
    for (const Setting& setting : s.settings) study.series.back().settings.push_back(results.take(setting));
  }
  std::vector<std::pair<SettingResult, SettingResult>> input_results;
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
    SettingResult low = results.take(ends[i]);
    input_results.emplace_back(std::move(low), results.take(ends[i + 1]));
  }
  fill_inputs(study, input_results);
  judge(study, holds_closed_form(scene) ? scene.closed_form : std::map<std::string, double>());
  return study;
}

}  // namespace cli::study
