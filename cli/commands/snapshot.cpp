// crashreel snapshot DIR: do the scenes of a folder still look and measure as their baselines say? Says no with exit code 1.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "cli/command.h"
#include "cli/estimate.h"
#include "cli/exit.h"
#include "cli/output/json.h"
#include "cli/output/lock.h"
#include "cli/output/whole_file.h"
#include "cli/parse.h"
#include "cli/progress.h"
#include "cli/scene_run.h"
#include "cli/snapshot/baselines.h"
#include "cli/snapshot/check.h"
#include "cli/snapshot/report.h"
#include "cli/snapshot/update.h"

namespace cli {
namespace {

namespace fs = std::filesystem;
constexpr const char* kReport = "report.json";

struct SnapshotWish {
  std::string folder;
  std::string report = "snapshot-report";
  bool update = false;
  std::vector<std::string> names;
  std::vector<std::string> allow;
  std::string jobs;
  std::string max_memory;
  bool json = false;
  bool quiet = false;
};

/// A report replaces an earlier one, and nothing else. Until it is whole, report.json says that it is not: a check that was stopped
/// is no pass.
void prepare_report(const fs::path& folder) {
  make_writable_folder(folder);
  if (!fs::is_empty(folder) && !fs::exists(folder / kReport))
    throw UsageError(fmt::format("{} is not empty and holds no report; give another --report", folder.string()));
  write_whole(folder / kReport, "{\"schema\": 1, \"same\": false, \"unfinished\": true}\n");
  fs::remove_all(folder / "pictures");
  for (const char* file : {"report.html", "junit.xml"}) fs::remove(folder / file);
  make_writable_folder(folder / "pictures");
}

/// Baselines below the folder that no scene names. Those of a scene that could not be read are left alone.
Json orphans_of(const fs::path& root, const Json& scenes) {
  Json out = Json::array();
  if (!fs::is_directory(root)) return out;  // one scene knows nothing of its neighbours'
  std::map<fs::path, std::set<std::string>> named;
  std::map<fs::path, std::vector<std::string>> unread;
  for (const Json& scene : scenes) {
    const fs::path file = root / scene["scene"].get<std::string>();
    const fs::path folder = baseline_folder(file).lexically_normal();
    for (const Json& name : scene["names"]) named[folder].insert(name.get<std::string>());
    if (scene["names"].empty() && !scene["errors"].empty()) unread[folder].push_back(file.stem().string() + "_");
  }
  std::set<fs::path> folders;
  for (const auto& entry : fs::recursive_directory_iterator(root))
    if (entry.is_directory() && entry.path().filename() == "snapshots") folders.insert(entry.path().lexically_normal());
  for (const fs::path& folder : folders)
    for (const std::string& name : kept(folder)) {
      const auto of_it = [&name](const std::string& stem) { return name.starts_with(stem); };
      if (named[folder].contains(name) || std::any_of(unread[folder].begin(), unread[folder].end(), of_it)) continue;
      out.push_back({{"name", name}, {"file", (folder / (name + ".png")).string()}});
    }
  return out;
}

void tell(const Json& report, const fs::path& folder) {
  for (const Json& scene : report["scenes"]) {
    const std::string name = scene["scene"];
    for (const Json& error : scene["errors"]) fmt::print("error      {}: {}\n", name, error.get<std::string>());
    for (const char* list : {"measures", "pictures"})
      for (const Json& item : scene[list]) {
        if (item["verdict"] == "same") continue;
        const std::string why = item["why"];
        fmt::print("{:<10} {}: {}{}{}\n", item["verdict"].get<std::string>(), name,
                   item[item.contains("metric") ? "metric" : "name"].get<std::string>(), why.empty() ? "" : ": ", why);
        if (item.contains("side_by_side"))
          fmt::print("           see {}\n", (folder / item["side_by_side"].get<std::string>()).string());
      }
    if (const std::string cause = cause_of(scene); !cause.empty()) fmt::print("           {}: {}\n", name, cause);
  }
  for (const Json& orphan : report["orphans"]) fmt::print("orphaned   no scene names {}\n", orphan["file"].get<std::string>());
  const auto count = [&report](const char* verdict) { return report["counts"][verdict].get<int>(); };
  std::string counts = fmt::format("{} pictures and {} measures unchanged", count("same"), count("measures_same"));
  for (const auto& [verdict, number] : report["counts"].items())
    if (number != 0 && verdict != "same" && verdict != "measures_same")
      counts += fmt::format(", {} {}", number.get<int>(), verdict == "measures_off" ? "measures off" : verdict);
  fmt::print("{}; {}\n", counts, (folder / "report.html").string());
}

int snapshot(const SnapshotWish& wish) {
  if (wish.update && wish.names.empty() && isatty(STDIN_FILENO) == 0)
    throw UsageError(
        "--update asks before it replaces anything, and there is no terminal to ask on; name what you have looked at: "
        "--update pose_cat_side_0s 'puck_*'");
  const fs::path root = wish.folder;
  const std::vector<fs::path> files = find_scenes(root);
  CheckJob job;
  job.root = fs::is_directory(root) ? root : root.has_parent_path() ? root.parent_path() : fs::path(".");
  job.report = wish.report;
  job.only = wish.names;
  job.allow.assign(wish.allow.begin(), wish.allow.end());
  job.workers = wish.jobs.empty() ? 0 : parse_integer("--jobs", wish.jobs, 1, 256);
  job.memory = wish.max_memory.empty() ? 0 : parse_bytes("--max-memory", wish.max_memory);
  job.quiet = wish.quiet;
  const OutputLock lock(wish.report);
  prepare_report(wish.report);

  const double start = clock_seconds();
  Progress progress("check", "scenes", static_cast<double>(files.size()),
                    wish.quiet ? ShowProgress::never : ShowProgress::automatic);
  Json report = {{"schema", 1}, {"version", CRASHREEL_VERSION}, {"folder", job.root.string()}};
  report["scenes"] = check_scenes(files, job, [&progress](int done) { progress.at(done); });
  progress.finish(static_cast<double>(files.size()));
  report["orphans"] = orphans_of(root, report["scenes"]);
  report["wall_s"] = clock_seconds() - start;
  if (wish.update) {
    refuse_names_nothing_has(wish.names, report);
    update_baselines(wish.names, wish.report, report);
  }
  count_verdicts(report);

  write_whole(fs::path(wish.report) / "report.html", report_html(report, wish.report));
  write_whole(fs::path(wish.report) / "junit.xml", junit_xml(report));
  write_whole(fs::path(wish.report) / kReport, json_text(report) + "\n");
  if (wish.json) {
    fmt::print("{}\n", json_text(report));
  } else {
    tell(report, wish.report);
  }
  return report["same"] ? kDone : kComparisonSaysNo;
}

}  // namespace

std::function<int()> declare_snapshot(Arguments& arguments) {
  const auto wish = std::make_shared<SnapshotWish>();
  arguments.positional("DIR", wish->folder, "folder of scenes (looked through with its folders), or one scene");
  arguments.list("--update", wish->update, wish->names, "NAME",
                 "replace baselines: those of the scenes or pictures named (* and ? allowed), or after asking for each");
  arguments.option("--report", wish->report, "OUT",
                   "folder for report.html, junit.xml, report.json and pictures; default: snapshot-report");
  arguments.option("-j,--jobs", wish->jobs, "N", "scenes at once, each in a process; default: one a core");
  arguments.option("--max-memory", wish->max_memory, "SIZE",
                   "all scenes at once take no more memory than this (2 GB); default: what the machine has");
  declare_allow(arguments, wish->allow);
  arguments.flag("--json", wish->json, "print report.json");
  arguments.flag("-q,--quiet", wish->quiet, "no progress");
  return [wish] { return snapshot(*wish); };
}

}  // namespace cli
