// A scene file in a folder of its own, for tests that write what they load.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace scenes::testing {

class SceneFolder {
 public:
  SceneFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "crashreel_scene_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~SceneFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  Scene load(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    return scenes::load(write("case.toml", text), overrides);
  }

  /// What the loader complains of, with the folder's name taken out of it.
  std::vector<std::string> errors(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    try {
      load(text, overrides);
    } catch (const SceneErrors& error) {
      std::vector<std::string> out = error.lines;
      for (std::string& line : out) {
        const std::string prefix = folder_.string() + "/";
        for (auto at = line.find(prefix); at != std::string::npos; at = line.find(prefix)) line.erase(at, prefix.size());
      }
      return out;
    }
    return {};
  }
  const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

/// One for all tests of a program that write no other file than the scene.
inline const SceneFolder& folder() {
  static const SceneFolder one;
  return one;
}

}  // namespace scenes::testing
