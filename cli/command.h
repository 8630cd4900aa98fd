// A command is one file in commands/ and one line in the table of command.cpp.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cli/arguments.h"

namespace cli {

struct Command {
  const char* name;
  const char* summary;
  /// Declares the command's arguments; what it returns runs the command and gives the exit code.
  std::function<int()> (*declare)(Arguments&);
};

std::span<const Command> commands();

/// Reads the command line, runs the command it names and returns the exit code. --help goes to standard output. Throws UsageError.
int run_command_line(int argc, const char* const* argv);

}  // namespace cli
