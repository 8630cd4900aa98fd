#include "cli/snapshot/baselines.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "cli/exit.h"
#include "cli/film_plan.h"
#include "cli/output/whole_file.h"
#include "scenes/error.h"
#include "scenes/loader/value.h"

namespace cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "snapshots";

bool wants_a_test(const fs::path& file) {
  try {
    const scenes::Value root = scenes::parse_file(file);
    const scenes::Value* output = root.find("output");
    return (output && output->find("still")) || root.find("expect");
  } catch (const scenes::SceneErrors&) {
    return true;
  }
}

}  // namespace

std::vector<fs::path> find_scenes(const fs::path& place) {
  std::error_code problem;
  if (!fs::exists(place, problem))
    throw MachineError(fmt::format("looking for scenes in {}: there is no such folder", place.string()));
  std::vector<fs::path> out;
  if (fs::is_regular_file(place)) {
    out.push_back(place);
  } else {
    fs::recursive_directory_iterator end, at(place);
    for (; at != end; ++at) {
      const std::string name = at->path().filename().string();
      if (at->is_directory() && (name.starts_with(".") || name == kFolder)) at.disable_recursion_pending();
      if (at->is_regular_file() && at->path().extension() == ".toml" && wants_a_test(at->path())) out.push_back(at->path());
    }
  }
  if (out.empty()) {
    throw UsageError(fmt::format("no scene in {} names a picture to test; add to one of them\n\n[[output.still]]\ntime = \"0.5 s\"",
                                 place.string()));
  }
  std::sort(out.begin(), out.end());
  return out;
}

fs::path baseline_folder(const fs::path& scene) {
  return scene.parent_path() / kFolder;
}

std::vector<Still> stills_of(const scenes::Scene& scene) {
  std::vector<Still> out;
  for (const auto& [time, camera, card] : scene.output.stills) {
    Still still;
    still.moment = camera.empty() ? still_of({}, scene.stage, time) : render::Moment{time, camera, 1};
    still.moment.card = card;
    const std::string seen = card >= 0 ? fmt::format("card{}", card + 1) : camera.empty() ? "film" : camera;
    still.name = fmt::format("{}_{}_{:g}s", scene.path.stem().string(), seen, time);
    // a camera's name may hold what a file's may not
    std::replace(still.name.begin(), still.name.end(), '/', '_');
    still.baseline = baseline_folder(scene.path) / (still.name + ".png");
    const auto same = [&still](const Still& other) { return other.name == still.name; };
    if (std::none_of(out.begin(), out.end(), same)) out.push_back(std::move(still));
  }
  return out;
}

std::set<std::string> listed(const fs::path& folder) {
  std::set<std::string> out;
  std::ifstream in(folder / kList);
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) out.insert(line);
  return out;
}

void write_list(const fs::path& folder, const std::set<std::string>& names) {
  WholeFile file(folder / kList);
  for (const std::string& name : names) file.write(name + "\n");
  file.close();
  file.publish();
}

std::set<std::string> kept(const fs::path& folder) {
  std::set<std::string> out = listed(folder);
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing))
    if (entry.path().extension() == ".png") out.insert(entry.path().stem().string());
  return out;
}

}  // namespace cli
