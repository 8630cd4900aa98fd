// Where baselines lie: in the folder `snapshots` beside each scene, SCENE_CAMERA_TIMEs.png, listed in list.txt. The list tells a
// picture nobody has accepted yet (new) from one that was accepted and is gone (missing).
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "render/arrange.h"
#include "scenes/scene.h"

namespace cli {

/// One picture that a scene names.
struct Still {
  render::Moment moment;
  std::string name;  // "pose_cat_side_0s"; "overlays_film_0.3s" of one that names no camera and is seen as the film shows it
  std::filesystem::path baseline;
};

/// Scene files at or below `place` that name stills or expected measures, in order of their names. A file that is no TOML counts,
/// so that its error is told. Throws MachineError when there is no such place, UsageError when nothing there is a scene to test.
std::vector<std::filesystem::path> find_scenes(const std::filesystem::path& place);

/// Stills of the scene, a camera and time given twice once.
std::vector<Still> stills_of(const scenes::Scene&);

std::filesystem::path baseline_folder(const std::filesystem::path& scene);

constexpr const char* kList = "list.txt";

/// The names in a folder's list.txt; none without one.
std::set<std::string> listed(const std::filesystem::path& folder);
void write_list(const std::filesystem::path& folder, const std::set<std::string>&);

/// Pictures in the folder, by name, and names in its list.
std::set<std::string> kept(const std::filesystem::path& folder);

}  // namespace cli
