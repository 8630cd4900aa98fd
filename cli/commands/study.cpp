// crashreel study SCENE -o DIR: what accuracy costs in time.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/output/json.h"
#include "cli/output/lock.h"
#include "cli/output/whole_file.h"
#include "cli/parse.h"
#include "cli/process.h"
#include "cli/scene_run.h"
#include "cli/study/effects.h"
#include "cli/study/output.h"
#include "cli/study/page.h"
#include "cli/study/picture.h"
#include "cli/study/pool.h"
#include "cli/study/quantities.h"
#include "cli/study/run.h"
#include "cli/study/target.h"

namespace cli {
namespace {

struct StudyWish {
  SceneArguments scene;
  std::string folder;
  std::string jobs;
  std::string ensemble = "8";
  std::vector<std::string> inputs;
  std::string target;
  std::string at;
  bool effects = false, picture = false;
  bool overwrite = false;
};

/// The five files of one kind of study, and what is said of them.
struct Report {
  std::string name;  // "study"
  std::string csv, text;
  nlohmann::ordered_json json;
  render::charts::Page page;
};

void refuse_existing_report(const StudyWish& wish, const std::string& name) {
  for (const char* extension : {".csv", ".json", ".pdf", ".svg", ".png"})
    refuse_existing(std::filesystem::path(wish.folder) / (name + extension), wish.overwrite);
}

void write_report(const StudyWish& wish, const Report& report) {
  const std::filesystem::path folder = wish.folder;
  write_whole(folder / (report.name + ".csv"), report.csv);
  write_whole(folder / (report.name + ".json"), json_text(report.json) + "\n");
  render::charts::write_page(report.page, folder / report.name);
  if (wish.scene.json)
    fmt::print("{}\n", json_text(report.json));
  else
    fmt::print("{0}{1}: {2}.csv, {2}.json, {2}.pdf, {2}.svg, {2}.png\n", report.text, wish.folder, report.name);
}

/// The moment of --at, else the first the scene is pictured at, else the middle of the run.
render::Moment moment_of(const StudyWish& wish, const scenes::Scene& scene, const engine::Recording& recording) {
  double time = recording.end_time() / 2;
  if (!scene.output.stills.empty()) time = scene.output.stills.front().time;
  if (!wish.at.empty()) time = parse_time("--at", wish.at);
  for (const render::Shot& shot : scene.stage.shots)
    if (time >= shot.from && time <= shot.to) return {time, shot.camera};
  return {time, scene.stage.cameras.front().name};
}

Report of_picture(const StudyWish& wish, const scenes::Scene& scene) {
  const engine::Recording recording = run_scene(scene, plan_of(scene), wish.scene);
  const study::PictureStudy result =
      study::study_picture(scene, recording, moment_of(wish, scene, recording), scene.output.width, scene.output.height);
  return {"picture", study::picture_csv(result), study::picture_text(result), study::picture_json(scene, result),
          study::picture_page(scene, result)};
}

Report of_effects(const scenes::Scene& scene, const study::RunWish& run) {
  const study::EffectsStudy result = study::study_effects(scene, run);
  return {"effects", study::effects_csv(result), study::effects_text(scene, result), study::effects_json(scene, result),
          study::effects_page(scene, result)};
}

Report of_accuracy(const StudyWish& wish, const scenes::Scene& scene, const study::RunWish& run) {
  const study::Study result = study::run_study(scene, run);
  Report out{"study", study::study_csv(result), study::study_text(scene, result), study::study_json(scene, result),
             study::page_of(scene, result)};
  if (!wish.target.empty()) out.text += "\n" + study::search(result, study::parse_target(wish.target)).text + "\n";
  return out;
}

/// What a study would notice only after its runs: one run shows which measures there are.
void refuse_before_work(const StudyWish& wish, const scenes::Scene& scene) {
  study::check_inputs(scene, wish.inputs);
  if (wish.target.empty()) return;
  const study::Target target = study::parse_target(wish.target);
  std::vector<std::string> names;
  SceneArguments quiet = wish.scene;
  quiet.quiet = true;
  const engine::Recording recording = run_scene(scene, plan_of(scene), quiet);
  for (const study::Quantity& quantity : study::quantities_of(scene.model, recording)) names.push_back(quantity.name);
  study::check_target(target, names);
}

int run(const StudyWish& wish) {
  const scenes::Scene scene = load_scene(wish.scene);
  plan_of(scene);  // refuses effects that do not exist
  study::RunWish run;
  run.folder = wish.folder;
  run.jobs = wish.jobs.empty() ? study::available_cores() : parse_integer("--jobs", wish.jobs, 1, 1024);
  run.options.members = parse_integer("--ensemble", wish.ensemble, 0, 1000);
  run.inputs = wish.inputs;
  run.show = progress_of(wish.scene);
  if (wish.effects && wish.picture) throw UsageError("--effects and --picture are studies of their own; give one of them");
  make_writable_folder(run.folder);
  // one for all kinds of study: they share DIR/runs
  const OutputLock lock(run.folder / "study", [](const std::string& name) {
    return name.starts_with("study.") || name.starts_with("effects.") || name.starts_with("picture.");
  });
  clear_parts(run.folder / "runs", [](const std::string& name) { return name.ends_with(".json"); });
  refuse_existing_report(wish, wish.effects ? "effects" : wish.picture ? "picture" : "study");
  if (!wish.effects && !wish.picture) refuse_before_work(wish, scene);
  tell_when_stopped(fmt::format("finished runs are kept in {}/runs, and the same command goes on from there", wish.folder));
  Report report = wish.effects ? of_effects(scene, run) : wish.picture ? of_picture(wish, scene) : of_accuracy(wish, scene, run);
  report.json["warnings"] = scene.stage.warnings;
  for (const std::string& warning : scene.stage.warnings) report.text += fmt::format("  warning: {}\n", warning);
  write_report(wish, report);
  return kDone;
}

}  // namespace

std::function<int()> declare_study(Arguments& arguments) {
  const auto wish = std::make_shared<StudyWish>();
  declare_scene_file(arguments, wish->scene);
  declare_progress(arguments, wish->scene);
  arguments.required_option("-o,--output", wish->folder, "DIR",
                            "folder for the results; made if missing. Finished runs stay in DIR/runs");
  arguments.option("--jobs", wish->jobs, "N", "runs side by side, one core each (default: every core)");
  arguments.option("--ensemble", wish->ensemble, "N", "minutely perturbed runs at each step (default 8)");
  arguments.repeatable("--input", wish->inputs, "PATH=LOW..HIGH",
                       "range of a value of the scene, for its share of the uncertainty");
  arguments.option("--target", wish->target, "MEASURE=WIDTH", "name the cheapest setting that holds it: throw_distance=0.05m");
  arguments.flag("--effects", wish->effects, "what each physical effect does and costs: each left out in turn");
  arguments.flag("--picture", wish->picture, "what the quality of a picture costs: error and milliseconds a frame");
  arguments.option("--at", wish->at, "TIME", "the moment of --picture (default: the scene's first still)");
  arguments.flag("--overwrite", wish->overwrite, "replace results that exist; finished runs are used again");
  return [wish] { return run(*wish); };
}

}  // namespace cli
