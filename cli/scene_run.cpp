#include "cli/scene_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/drawn_reach.h"
#include "cli/estimate.h"
#include "cli/exit.h"
#include "cli/foresight.h"
#include "cli/output/recording_file.h"
#include "cli/output/summary.h"
#include "cli/process.h"
#include "engine/measure/flung.h"
#include "engine/measure/glance.h"
#include "engine/measure/passage.h"
#include "engine/simulate.h"
#include "scenes/loader/value.h"

namespace cli {
namespace {

/// --effects gravity=off is --set simulation.effects.gravity=off, in fewer letters.
std::string as_override(const std::string& wish) {
  const std::size_t equals = wish.find('=');
  const std::string state = equals == std::string::npos ? "" : wish.substr(equals + 1);
  if (equals == 0 || (state != "on" && state != "off" && state != "auto")) {
    throw UsageError(fmt::format("--effects is \"{}\": must be NAME=on, NAME=off or NAME=auto", wish));
  }
  return fmt::format("simulation.effects.{}={}", wish.substr(0, equals), state == "auto" ? "automatic" : state);
}

/// A run's folder stands for the scene it was made of, with the values it was run with. Nothing when it is no such folder.
std::optional<SceneArguments> scene_of_run(const SceneArguments& wish) {
  namespace fs = std::filesystem;
  std::error_code problem;
  if (!fs::is_directory(wish.scene, problem)) return std::nullopt;
  std::ifstream file(fs::path(wish.scene) / "summary.json");
  const auto summary = file ? nlohmann::json::parse(file, nullptr, false) : nlohmann::json();
  if (!summary.is_object() || !summary.contains("scene") || !summary["scene"].is_object()) return std::nullopt;
  const auto& of = summary["scene"];
  SceneArguments out = wish;
  std::vector<std::string> run_with;
  std::string sha256;
  try {
    run_with = of.value("overrides", run_with);
    out.scene = of.value("path", "");
    sha256 = of.value("sha256", "");
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;  // of another kind than `simulate` writes them
  }
  out.set = run_with;
  const auto refuse = [&](const std::string& why) {
    throw UsageError(fmt::format("{} holds a run of {}, {}; name a scene file", wish.scene, out.scene, why));
  };
  if (!fs::is_regular_file(out.scene, problem)) refuse("which is not there (paths are as in the folder where it was run)");
  if (sha256 != scenes::load(scenes::read_scene_file(out.scene, {wish.allow.begin(), wish.allow.end()}), run_with).sha256)
    refuse("which has been changed since");
  out.set.insert(out.set.end(), wish.set.begin(), wish.set.end());
  return out;
}

/// What --set changed, for the titles of pictures: a film must not say 40 km/h over a run at 50.
std::string told_overrides(const std::vector<std::string>& overrides) {
  constexpr std::size_t kMost = 3, kLongest = 80;
  std::string out = fmt::format("{}", fmt::join(overrides, ", "));
  if (overrides.size() > kMost || out.size() > kLongest)
    out = overrides.size() == 1 ? "a value of the file" : fmt::format("{} values of the file", overrides.size());
  return fmt::format(" [changed: {}]", out);
}

/// --verbose: what the run is made of, and what each part of it cost.
void tell_plan(const engine::Plan& plan) {
  for (const engine::PlanLine& line : plan.lines) {
    if (line.active) fmt::print(stderr, "effect {}: {}\n", line.effect, line.reason);
  }
}

void tell_costs(const engine::Recording& recording) {
  for (const engine::EffectCost& cost : recording.costs) {
    fmt::print(stderr, "effect {}: {} calls, {:.1f} ms\n", cost.effect, cost.calls, 1e3 * cost.wall_s);
  }
}

}  // namespace

void declare_allow(Arguments& arguments, std::vector<std::string>& allow) {
  arguments.repeatable("--allow", allow, "DIR", "let the scene name meshes and pictures below this folder too");
}

void declare_scene_file(Arguments& arguments, SceneArguments& scene) {
  arguments.positional("SCENE", scene.scene, "scene file (TOML)");
  arguments.repeatable("--set", scene.set, "PATH=VALUE", "change a value of the scene: --set vehicle.sedan.speed=\"50 km/h\"");
  declare_allow(arguments, scene.allow);
  arguments.flag("--json", scene.json, "print the result as JSON");
  arguments.flag("-q,--quiet", scene.quiet, "no progress, no warnings");
  arguments.flag("-v,--verbose", scene.verbose, "tell the effects of the run and what each cost");
}

void declare_scene(Arguments& arguments, SceneArguments& scene) {
  declare_scene_file(arguments, scene);
  arguments.repeatable("--effects", scene.effects, "NAME=on|off|auto",
                       "force a physical effect on or off, or leave it to the plan");
}

void declare_progress(Arguments& arguments, SceneArguments& scene) {
  arguments.choice("--progress", scene.progress, {"auto", "always", "never"}, "progress on standard error");
}

ShowProgress progress_of(const SceneArguments& scene) {
  if (scene.quiet || scene.progress == "never") return ShowProgress::never;
  return scene.progress == "always" ? ShowProgress::always : ShowProgress::automatic;
}

scenes::Scene load_scene(const SceneArguments& given, double memory_ceiling) {
  const SceneArguments wish = scene_of_run(given).value_or(given);
  std::vector<std::string> overrides = wish.set;
  for (const std::string& effect : wish.effects) overrides.push_back(as_override(effect));
  const LoadingLimit limit(memory_ceiling);
  scenes::Scene scene = scenes::load(scenes::read_scene_file(wish.scene, {wish.allow.begin(), wish.allow.end()}), overrides);
  if (!wish.quiet) {
    for (const std::string& warning : scene.warnings) fmt::print(stderr, "{}\n", warning);
  }
  scene.stage.provenance = fmt::format("crashreel {} | {}", CRASHREEL_VERSION, scene.stage.provenance);
  if (!wish.set.empty()) {
    scene.stage.title += told_overrides(wish.set);
    for (render::Card& card : scene.stage.cards) card.lines.insert(card.lines.begin(), told_overrides(wish.set).substr(1));
  }
  for (const auto& [name, force] : scene.model.settings.effects) {
    if (force == engine::Force::off) scene.stage.warnings.push_back(fmt::format("effect {} switched off by the author", name));
  }
  return scene;
}

std::string heading_of(const scenes::Scene& scene) {
  return (scene.title.empty() ? scene.path.filename().string() : scene.title) +
         (scene.overrides.empty() ? "" : told_overrides(scene.overrides));
}

engine::Plan plan_of(const scenes::Scene& scene) {
  engine::Plan plan = engine::compile(scene.model);
  std::vector<std::string> names;
  for (const engine::PlanLine& line : plan.lines) names.push_back(line.effect);
  for (const auto& [name, force] : scene.model.settings.effects) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    const std::string near = scenes::nearest(name, names);
    throw UsageError(fmt::format(
        "simulation.effects.{}: there is no effect of that name{}", name,
        near.empty() ? fmt::format("; take one of {}", fmt::join(names, ", ")) : fmt::format("; did you mean {}?", near)));
  }
  return plan;
}

namespace {

/// What `simulate` has kept of this very run, where its folder is named and nothing is changed.
std::optional<engine::Recording> kept_run(const scenes::Scene& scene, const SceneArguments& wish) {
  if (!std::filesystem::is_directory(wish.scene) || !wish.set.empty() || !wish.effects.empty()) return std::nullopt;
  return read_recording(std::filesystem::path(wish.scene) / kRecordingFile, scene);
}

engine::Recording simulated(const scenes::Scene& scene, const engine::Plan& plan, const SceneArguments& wish, Costs costs) {
  Progress progress("simulate", "s", scene.model.settings.duration, progress_of(wish));
  engine::RunOptions options;
  if (costs == Costs::timed || wish.verbose) options.clock = clock_seconds;
  options.step_clocks = {clock_seconds, computed_seconds};
  options.progress = [&progress](double time) {
    progress.at(time);
    return !interrupted();
  };
  const double start = clock_seconds();
  engine::Recording recording = engine::simulate(scene.model, plan, options);
  recording.wall_s = clock_seconds() - start;
  progress.finish(recording.end_time());
  check_interrupted();
  return recording;
}

}  // namespace

engine::Recording run_scene(const scenes::Scene& scene, const engine::Plan& plan, const SceneArguments& wish, Costs costs) {
  if (wish.verbose) tell_plan(plan);
  std::optional<engine::Recording> kept = costs == Costs::counted ? kept_run(scene, wish) : std::nullopt;
  engine::Recording recording = kept ? std::move(*kept) : simulated(scene, plan, wish, costs);
  if (wish.verbose) tell_costs(recording);

  // a run that left something out says so wherever its results go
  std::vector<std::string>& warnings = recording.diagnostics.warnings;
  warnings = warnings_of(scene, recording);
  if (!wish.quiet && nothing_touched(scene.model, recording)) {
    const std::vector<std::string> over = under_wheels(scene.model, recording);
    const std::string rolled = over.empty() ? "nothing touched" : fmt::format("wheels rolled over {}", fmt::join(over, " and "));
    fmt::print(stderr, "crashreel: note: {}: no vehicle or person met anything {}but the ground in this run\n", rolled,
               over.empty() ? "" : "else ");
  }
  if (!wish.quiet) {
    for (const std::string& warning : warnings) fmt::print(stderr, "crashreel: warning: {}\n", warning);
    if (const std::string slow = slow_step(recording); !slow.empty()) fmt::print(stderr, "crashreel: warning: {}\n", slow);
  }
  if (const auto& failure = recording.failure) {
    fmt::print(stderr, "crashreel: the model diverged at {:.4f} s, body {}, effect {}: {}; the recording up to there is kept\n",
               failure->time, failure->body, failure->effect, failure->message);
  }
  return recording;
}

std::vector<std::string> warnings_of(const scenes::Scene& scene, const engine::Recording& recording) {
  std::vector<std::string> out = recording.diagnostics.warnings, seen = scene.stage.warnings;
  for (const std::string& inside : inside_vehicles(scene.model)) seen.push_back(inside);
  for (const std::string& unfit : unfit_riders(scene.model)) seen.push_back(unfit);
  for (const std::string& glance : engine::doubtful_glances(scene.model, recording)) seen.push_back(glance);
  for (const std::string& passage : engine::passages(scene.model, recording)) seen.push_back(passage);
  for (const std::string& flung : engine::flung_parts(scene.model, recording)) seen.push_back(flung);
  for (const std::string& reach : drawn_reaches(scene, recording)) seen.push_back(reach);
  for (const std::string& warning : seen)
    if (std::find(out.begin(), out.end(), warning) == out.end()) out.push_back(warning);
  return out;
}

int exit_code_of(const engine::Recording& recording) {
  return recording.failure ? kModelDiverged : kDone;
}

}  // namespace cli
