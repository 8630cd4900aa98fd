// A command is one file in commands/ and one line in the table of command.cpp.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cli/arguments.h"

namespace cli {

/// A command line people start from, and what it does.
struct Example {
  const char* line;  // behind "crashreel "
  const char* does;
};

struct Command {
  const char* name;
  const char* summary;
  /// Declares the command's arguments; what it returns runs the command and gives the exit code.
  std::function<int()> (*declare)(Arguments&);
  std::span<const Example> examples = {};
};

/// An argument of a command as it is declared: what help, man pages and completions are made of.
struct ArgumentHelp {
  std::string names;  // "-o,--output", or SCENE
  std::string value;  // "OUT", "draft|standard|fine", empty for a flag
  std::string text;
  bool positional = false;
  bool required = false;
};

struct CommandHelp {
  const Command* command = nullptr;
  std::vector<ArgumentHelp> arguments;
};

/// Of every command, in the order of the table.
std::vector<CommandHelp> help_of_commands();

std::span<const Command> commands();
/// Throws UsageError: no such command, with the one that may be meant.
[[noreturn]] void refuse_command(const std::string& word);

/// What the command line asks for, which may be done once: a command, or its help on standard output. The job gives the exit code.
/// Nothing but the names of files is looked up before it runs. Throws UsageError.
std::function<int()> read_command_line(int argc, const char* const* argv);

/// Reads the command line, runs the command it names and returns the exit code. Throws UsageError, and what the
/// command throws.
int run_command_line(int argc, const char* const* argv);

}  // namespace cli
