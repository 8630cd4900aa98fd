// A scene with a slip in it, and all that the program says about it.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "tests/cli/program.h"

namespace cli_tests {

struct Slip {
  std::string name;
  std::string scene;
  std::string told;  // everything on standard error
};

inline void PrintTo(const Slip& slip, std::ostream* out) {
  *out << slip.name;
}

/// `check` of the scene, in a folder that has what else it names, says that and nothing else.
inline void expect_told(const Folder& folder, const Slip& slip) {
  folder.write("a.toml", slip.scene);
  const Result result = run(folder, {"check", "a.toml"});
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(result.err, slip.told);
}

/// A section that needs nothing more, and two lines before what comes after it.
inline const std::string kPerson = "[[person]]\nname = \"p\"\n";

}  // namespace cli_tests
