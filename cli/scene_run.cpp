#include "cli/scene_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/estimate.h"
#include "cli/exit.h"
#include "cli/process.h"
#include "engine/simulate.h"
#include "scenes/loader/value.h"

namespace cli {
namespace {

/// --effects gravity=off is --set simulation.effects.gravity=off, in fewer letters.
std::string as_override(const std::string& wish) {
  const std::size_t equals = wish.find('=');
  const std::string state = equals == std::string::npos ? "" : wish.substr(equals + 1);
  if (equals == 0 || (state != "on" && state != "off" && state != "auto")) {
    throw UsageError(fmt::format("--effects is \"{}\", must be NAME=on, NAME=off or NAME=auto", wish));
  }
  return fmt::format("simulation.effects.{}={}", wish.substr(0, equals), state == "auto" ? "automatic" : state);
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

scenes::Scene load_scene(const SceneArguments& wish, double memory_ceiling) {
  std::vector<std::string> overrides = wish.set;
  for (const std::string& effect : wish.effects) overrides.push_back(as_override(effect));
  const LoadingLimit limit(memory_ceiling);
  scenes::Scene scene = scenes::load(scenes::read_scene_file(wish.scene, {wish.allow.begin(), wish.allow.end()}), overrides);
  if (!wish.quiet) {
    for (const std::string& warning : scene.warnings) fmt::print(stderr, "{}\n", warning);
  }
  scene.stage.provenance = fmt::format("crashreel {} | {}", CRASHREEL_VERSION, scene.stage.provenance);
  for (const auto& [name, force] : scene.model.settings.effects) {
    if (force == engine::Force::off) scene.stage.warnings.push_back(fmt::format("effect {} switched off by the author", name));
  }
  return scene;
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

engine::Recording run_scene(const scenes::Scene& scene, const engine::Plan& plan, const SceneArguments& wish, Costs costs) {
  if (wish.verbose) tell_plan(plan);
  Progress progress("simulate", "s", scene.model.settings.duration, progress_of(wish));
  engine::RunOptions options;
  if (costs == Costs::timed || wish.verbose) options.clock = clock_seconds;
  options.progress = [&progress](double time) {
    progress.at(time);
    return !interrupted();
  };
  const double start = clock_seconds();
  engine::Recording recording = engine::simulate(scene.model, plan, options);
  recording.wall_s = clock_seconds() - start;
  progress.finish(recording.end_time());
  check_interrupted();
  if (wish.verbose) tell_costs(recording);

  // a run that left something out says so wherever its results go
  std::vector<std::string>& warnings = recording.diagnostics.warnings;
  for (const std::string& warning : scene.stage.warnings) {
    if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end()) warnings.push_back(warning);
  }
  if (!wish.quiet) {
    for (const std::string& warning : warnings) fmt::print(stderr, "crashreel: warning: {}\n", warning);
  }
  if (const auto& failure = recording.failure) {
    fmt::print(stderr, "crashreel: the model diverged at {:.4f} s, body {}, effect {}: {}; the recording up to there is kept\n",
               failure->time, failure->body, failure->effect, failure->message);
  }
  return recording;
}

int exit_code_of(const engine::Recording& recording) {
  return recording.failure ? kModelDiverged : kDone;
}

}  // namespace cli
