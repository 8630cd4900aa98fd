// Scenes are run, drawn and compared, each in a process of its own.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace cli {

struct CheckJob {
  std::filesystem::path root;                // names of scenes are told from here
  std::filesystem::path report;              // its folder `pictures` gets what is to be looked at
  std::vector<std::string> only;             // patterns of scene or picture names (* and ?); empty: everything
  std::vector<std::filesystem::path> allow;  // folders besides the scenes' own whose meshes and pictures these may name
  int workers = 0;                           // 0: one a core
  double memory = 0;                         // [byte] that all scenes checked at once may take; 0: what the machine has
  bool quiet = false;
};

/// What was found of one scene; these keys are those of report.json:
/// {"scene", "title", "names": [all its pictures], "errors": [...], "wall_s",
///  "pictures": [{"name", "baseline", "camera", "time_s", "verdict", "why", "figures", "limits", "actual", "difference",
///                "side_by_side"}],
///  "measures": [{"metric", "expected", "found", "verdict", "why"}]}
/// Verdicts of pictures: same, different, new, missing, unreadable; of measures: same, different, missing.
using SceneReport = nlohmann::ordered_json;

/// One report a scene, in the scenes' order whatever the number of workers. A scene whose process dies, or finds no memory within
/// its share, reports that as its error. Fewer are checked at once where a share would be too small for any scene.
std::vector<SceneReport> check_scenes(const std::vector<std::filesystem::path>& scenes, const CheckJob&,
                                      const std::function<void(int done)>& progress);

/// Whether a name fits one of the patterns, with or without ".png" or ".toml".
bool fits(const std::string& name, const std::vector<std::string>& patterns);

}  // namespace cli
