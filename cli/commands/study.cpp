// crashreel study SCENE -o DIR: what accuracy costs in time.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/output/whole_file.h"
#include "cli/parse.h"
#include "cli/scene_run.h"
#include "cli/study/output.h"
#include "cli/study/page.h"
#include "cli/study/pool.h"
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
  bool overwrite = false;
};

void write_whole(const std::filesystem::path& file, const std::string& text) {
  WholeFile whole(file);
  whole.write(text);
  whole.close();
  whole.publish();
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
  if (!wish.target.empty()) study::parse_target(wish.target);  // refused before the work, not after it
  make_writable_folder(run.folder);
  for (const char* name : {"study.csv", "study.json", "study.pdf", "study.svg", "study.png"})
    refuse_existing(run.folder / name, wish.overwrite);

  const study::Study result = study::run_study(scene, run);
  const nlohmann::ordered_json json = study::study_json(scene, result);
  write_whole(run.folder / "study.csv", study::study_csv(result));
  write_whole(run.folder / "study.json", json.dump(2) + "\n");
  render::charts::write_page(study::page_of(scene, result), run.folder / "study");
  if (wish.scene.json) {
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("{}", study::study_text(scene, result));
    fmt::print("{}: study.csv, study.json, study.pdf, study.svg, study.png\n", wish.folder);
    if (!wish.target.empty()) fmt::print("\n{}", study::search(result, study::parse_target(wish.target)).text);
  }
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
  arguments.flag("--overwrite", wish->overwrite, "replace results that exist; finished runs are used again");
  return [wish] { return run(*wish); };
}

}  // namespace cli
