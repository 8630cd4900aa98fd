// A scene with a slip in it, and all that the program says about it.
#pragma once

#include <ostream>
#include <string>

namespace cli_tests {

struct Slip {
  std::string name;
  std::string scene;
  std::string told;  // everything on standard error
};

inline void PrintTo(const Slip& slip, std::ostream* out) {
  *out << slip.name;
}

}  // namespace cli_tests
