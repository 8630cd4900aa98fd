#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace scenes {

/// The scene's author erred. Each line is "file:line:column: what, and the remedy".
struct SceneErrors : std::runtime_error {
  explicit SceneErrors(std::vector<std::string> found);
  std::vector<std::string> lines;
};

}  // namespace scenes
