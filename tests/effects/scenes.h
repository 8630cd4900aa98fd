// Every shipped scene with something to simulate: the cases and the gallery.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace effects_tests {

/// Paths relative to the sources, in the order of their names.
inline std::vector<std::string> shipped_scenes() {
  std::vector<std::string> out;
  const std::filesystem::path root = CRASHREEL_SOURCE_DIR;
  for (const char* folder : {"scenes/cases", "scenes/gallery"})
    for (const auto& entry : std::filesystem::directory_iterator(root / folder))
      if (entry.path().extension() == ".toml") out.push_back(std::string(folder) + "/" + entry.path().filename().string());
  std::sort(out.begin(), out.end());
  return out;
}

/// Those in which something happens: not the poses, which stand and wait.
inline std::vector<std::string> moving_scenes() {
  std::vector<std::string> out = shipped_scenes();
  std::erase_if(out, [](const std::string& path) { return path.find("/pose_") != std::string::npos; });
  return out;
}

/// A scene's path as the name of its test.
inline std::string test_name(std::string path) {
  path = path.substr(path.find('/') + 1);
  path.resize(path.size() - std::string(".toml").size());
  std::replace(path.begin(), path.end(), '/', '_');
  return path;
}

}  // namespace effects_tests
