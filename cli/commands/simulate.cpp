// crashreel simulate SCENE -o DIR: trajectory.csv, contacts.csv, summary.json.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/output/csv.h"
#include "cli/output/summary.h"
#include "cli/output/whole_file.h"
#include "cli/scene_run.h"

namespace cli {
namespace {

struct SimulateWish {
  SceneArguments scene;
  std::string folder;
  bool overwrite = false;
};

int simulate(const SimulateWish& wish) {
  // what cannot be written is told before the work, not after it
  const scenes::Scene scene = load_scene(wish.scene);
  const std::filesystem::path folder = wish.folder;
  make_writable_folder(folder);
  for (const char* name : {"trajectory.csv", "contacts.csv", "summary.json"}) refuse_existing(folder / name, wish.overwrite);

  const engine::Recording recording = run_scene(scene, plan_of(scene), wish.scene);
  const std::vector<engine::Metric> metrics = engine::measure(scene.model, recording);
  const nlohmann::ordered_json summary = summary_json(scene, recording, metrics);

  WholeFile trajectory(folder / "trajectory.csv");
  WholeFile contacts(folder / "contacts.csv");
  WholeFile summary_file(folder / "summary.json");
  write_trajectory(recording, trajectory);
  write_contacts(recording, contacts);
  summary_file.write(summary.dump(2) + "\n");
  for (WholeFile* file : {&trajectory, &contacts, &summary_file}) file->close();
  for (WholeFile* file : {&trajectory, &contacts, &summary_file}) file->publish();

  if (wish.scene.json) {
    fmt::print("{}\n", summary.dump(2));
  } else {
    fmt::print("{}", summary_text(scene, recording, metrics));
    fmt::print("{}: trajectory.csv, contacts.csv, summary.json\n", folder.string());
  }
  return exit_code_of(recording);
}

}  // namespace

std::function<int()> declare_simulate(Arguments& arguments) {
  const auto wish = std::make_shared<SimulateWish>();
  declare_scene(arguments, wish->scene);
  declare_progress(arguments, wish->scene);
  arguments.required_option("-o,--output", wish->folder, "DIR", "folder for the three files; made if missing");
  arguments.flag("--overwrite", wish->overwrite, "replace files that exist");
  return [wish] { return simulate(*wish); };
}

}  // namespace cli
