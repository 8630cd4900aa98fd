#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace scenes {

/// One thing that is wrong or odd: where it was written, of what kind it is, what it is and the remedy.
struct Finding {
  std::string file;  // a path, or the override that set it: "--set vehicle.car.mass=0"
  int line = 0;      // from 1; 0: not in a file
  int column = 0;    // from 1, in characters
  std::string code;  // for scripts: syntax, file, unknown_key, missing_key, unit, range, type, choice, override, value
  std::string what;
  /// "file:line:column: what"; without a column or a line these are left out.
  std::string text() const;
};

/// The scene's author erred. Each line is "file:line:column: what, and the remedy".
struct SceneErrors : std::runtime_error {
  explicit SceneErrors(std::vector<Finding> found);
  std::vector<Finding> findings;
  std::vector<std::string> lines;  // their texts
};

}  // namespace scenes
