// crashreel simulate SCENE -o DIR: trajectory.csv, contacts.csv, impacts.csv, recording.bin, summary.json.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/command.h"
#include "cli/estimate.h"
#include "cli/exit.h"
#include "cli/output/csv.h"
#include "cli/output/fingerprint.h"
#include "cli/output/json.h"
#include "cli/output/lock.h"
#include "cli/output/recording_file.h"
#include "cli/output/summary.h"
#include "cli/output/whole_file.h"
#include "cli/process.h"
#include "cli/scene_run.h"

namespace cli {
namespace {

struct SimulateWish {
  SceneArguments scene;
  std::string folder;
  bool overwrite = false;
  bool resume = false;
  bool dry_run = false;
  std::string max_memory;
};

constexpr const char* kSummary = "summary.json";
constexpr const char* kFiles[] = {"trajectory.csv", "contacts.csv", "impacts.csv", kRecordingFile, kSummary};

/// The summary of the whole result of this run, where the folder holds it: the summary gets its name last.
std::optional<nlohmann::ordered_json> finished(const std::filesystem::path& folder, const std::string& mark) {
  std::ifstream file(folder / kSummary);
  if (!file) return std::nullopt;
  auto found = nlohmann::ordered_json::parse(file, nullptr, false);
  if (!found.is_object() || found.value("fingerprint", nlohmann::ordered_json()) != mark)
    throw UsageError(
        fmt::format("{} was not made by this scene with these assets, options and version; give --overwrite in place of "
                    "--resume, or another -o",
                    (folder / kSummary).string()));
  std::error_code missing;
  for (const char* name : kFiles)
    if (!std::filesystem::is_regular_file(folder / name, missing)) return std::nullopt;
  return found;
}

int tell_estimate(const scenes::Scene& scene, const SimulateWish& wish) {
  const Estimate estimate = estimate_results(scene, plan_of(scene));
  if (wish.scene.json)
    fmt::print("{}\n", json_text(estimate_json(estimate)));
  else
    fmt::print("{}: {}\n", wish.folder, estimate_text(estimate, scene.model.settings.step));
  return kDone;
}

int simulate(const SimulateWish& wish, const Arguments& arguments) {
  // what cannot be written is told before the work, not after it
  const double ceiling = wish.max_memory.empty() ? 0 : parse_bytes("--max-memory", wish.max_memory);
  const scenes::Scene scene = load_scene(wish.scene, ceiling);
  const std::filesystem::path folder = wish.folder;
  if (wish.dry_run) return tell_estimate(scene, wish);
  make_writable_folder(folder);
  if (wish.resume && wish.overwrite) throw UsageError("--resume keeps what --overwrite replaces; give one of them");
  const OutputLock lock(folder / kSummary, [](const std::string& name) {
    return std::find(std::begin(kFiles), std::end(kFiles), name) != std::end(kFiles);
  });
  for (const char* name : kFiles) refuse_existing(folder / name, wish.overwrite || wish.resume);
  const std::string mark = fingerprint(ResultKind::whole, scene, arguments);
  if (wish.resume) {
    if (const auto summary = finished(folder, mark)) {
      if (wish.scene.json)
        fmt::print("{}\n", json_text(*summary));
      else
        fmt::print("{}: finished before\n", folder.string());
      return kDone;
    }
  }

  int no_workers = 0;
  if (ceiling > 0) hold_to_memory(estimate_results(scene, plan_of(scene)), ceiling, no_workers, wish.scene.quiet);
  tell_when_stopped("nothing was kept; the same command begins anew");
  const engine::Recording recording = run_scene(scene, plan_of(scene), wish.scene, Costs::timed);
  const std::vector<engine::Metric> metrics = engine::measure(scene.model, recording);
  nlohmann::ordered_json summary = summary_json(scene, recording, metrics);
  summary["fingerprint"] = mark;

  WholeFile trajectory(folder / "trajectory.csv");
  WholeFile contacts(folder / "contacts.csv");
  WholeFile impacts(folder / "impacts.csv");
  WholeFile recording_file(folder / kRecordingFile);
  WholeFile summary_file(folder / kSummary);
  write_trajectory(recording, trajectory);
  write_contacts(recording, contacts);
  write_impacts(engine::impacts_of(scene.model, recording), impacts);
  recording_file.write(recording_bytes(scene, recording));
  summary_file.write(json_text(summary) + "\n");
  for (WholeFile* file : {&trajectory, &contacts, &impacts, &recording_file, &summary_file}) file->close();
  // an old summary must not stand beside a new trajectory, whenever the power fails
  std::error_code none;
  std::filesystem::remove(folder / kSummary, none);
  for (WholeFile* file : {&trajectory, &contacts, &impacts, &recording_file, &summary_file}) file->publish();

  if (wish.scene.json) {
    fmt::print("{}\n", json_text(summary));
  } else {
    fmt::print("{}", summary_text(scene, recording, metrics));
    fmt::print("{}: trajectory.csv, contacts.csv, impacts.csv, recording.bin, summary.json\n", folder.string());
  }
  return exit_code_of(recording);
}

}  // namespace

std::function<int()> declare_simulate(Arguments& arguments) {
  const auto wish = std::make_shared<SimulateWish>();
  declare_scene(arguments, wish->scene);
  declare_progress(arguments, wish->scene);
  arguments.required_option("-o,--output", wish->folder, "DIR", "folder for the files; made if missing");
  arguments.flag("--overwrite", wish->overwrite, "replace files that exist");
  arguments.flag("--resume", wish->resume, "begin, or go on where the same command was stopped; keeps a finished result");
  arguments.flag("--dry-run", wish->dry_run, "print the steps, bytes and seconds to expect, and stop");
  arguments.option("--max-memory", wish->max_memory, "SIZE",
                   "take no more memory than this (2 GB), or end with an error before the start");
  return [wish, arguments] { return simulate(*wish, arguments); };
}

}  // namespace cli
