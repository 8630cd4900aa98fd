#include "cli/snapshot/update.h"

#include <fmt/format.h>

#include <iostream>
#include <set>

#include "cli/exit.h"
#include "cli/output/json.h"
#include "cli/output/lock.h"
#include "cli/output/whole_file.h"
#include "cli/snapshot/baselines.h"
#include "cli/snapshot/check.h"
#include "render/image/png.h"
#include "scenes/loader/value.h"

namespace cli {
namespace {

namespace fs = std::filesystem;
/// Somebody at the terminal, asked about one thing at a time until there is an end to it.
class Asker {
 public:
  bool says_yes(const std::string& what) {
    if (enough_) return false;
    fmt::print(stderr, "{}? [y/N/q] ", what);
    std::string answer;
    if (!std::getline(std::cin, answer) || answer == "q") enough_ = true;
    return answer == "y" || answer == "yes";
  }

 private:
  bool enough_ = false;
};

void relist(const fs::path& folder, const std::string& name, bool is_kept) {
  const OutputLock lock(folder / kList);  // others may update other pictures of the folder
  std::set<std::string> names = listed(folder);
  if (is_kept ? names.insert(name).second : names.erase(name) > 0) write_list(folder, names);
}

std::string question_about(const Json& picture, const fs::path& folder) {
  const std::string verdict = picture["verdict"], name = picture["name"], why = picture["why"];
  const std::string look = picture[picture.contains("side_by_side") ? "side_by_side" : "actual"];
  return fmt::format("{}: {}{}{}\n  look at {}\n  keep the actual picture as baseline", verdict, name, why.empty() ? "" : ": ", why,
                     (folder / look).string());
}

void accept(Json& picture, const fs::path& folder) {
  const fs::path baseline = picture["baseline"].get<std::string>();
  make_writable_folder(baseline.parent_path());
  const OutputLock lock(baseline);
  // written anew: the file of the report may be deleted, edited or half of a full disk
  render::write_png(baseline, render::read_png(folder / picture["actual"].get<std::string>()), {}, render::PngEffort::small);
  relist(baseline.parent_path(), picture["name"], true);
  picture["verdict"] = "updated";
  picture["why"] = "";
}

}  // namespace

void refuse_names_nothing_has(const std::vector<std::string>& patterns, const SnapshotReport& report) {
  std::vector<std::string> names;
  for (const Json& scene : report["scenes"]) {
    names.push_back(fs::path(scene["scene"].get<std::string>()).stem().string());
    for (const Json& name : scene["names"]) names.push_back(name);
  }
  for (const Json& orphan : report["orphans"]) names.push_back(orphan["name"]);
  for (const std::string& pattern : patterns) {
    const auto it_fits = [&pattern](const std::string& name) { return fits(name, {pattern}); };
    if (std::any_of(names.begin(), names.end(), it_fits)) continue;
    const std::string near = scenes::nearest(pattern, names);
    throw UsageError(fmt::format("--update: no scene, picture or orphan is called {}{}", pattern,
                                 near.empty() ? "" : fmt::format("; did you mean {}?", near)));
  }
}

void update_baselines(const std::vector<std::string>& patterns, const fs::path& folder, SnapshotReport& report) {
  Asker asker;
  const bool by_name = !patterns.empty();
  for (Json& scene : report["scenes"])
    for (Json& picture : scene["pictures"]) {
      // a baseline that lies there with the right picture was accepted, whatever became of the list
      if (picture["verdict"] == "same")
        relist(fs::path(picture["baseline"].get<std::string>()).parent_path(), picture["name"], true);
      if (picture.contains("actual") && (by_name || asker.says_yes(question_about(picture, folder)))) accept(picture, folder);
    }
  Json left = Json::array();
  for (const Json& orphan : report["orphans"]) {
    const fs::path file = orphan["file"].get<std::string>();
    const bool named = fits(orphan["name"], patterns);
    if (named || (!by_name && asker.says_yes(fmt::format("orphaned: no scene names {}\n  remove it", file.string())))) {
      fs::remove(file);
      relist(file.parent_path(), orphan["name"], false);
      fmt::print(stderr, "removed {}\n", file.string());
    } else if (!by_name) {
      left.push_back(orphan);
    }
  }
  report["orphans"] = left;
}

}  // namespace cli
