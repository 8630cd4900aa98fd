// What the program says of itself, all from the table of commands: --help, manual pages, completions.
#pragma once

#include <string>
#include <vector>

#include "cli/command.h"

namespace cli {

/// --help of one command: examples first, then its arguments.
std::string help_of(const CommandHelp&);
/// --help of the program: a first example, then the commands.
std::string overview_of(const std::vector<CommandHelp>&);

/// Manual page (section 1, roff) of a command, or of the program.
std::string man_page_of(const CommandHelp&);
std::string man_page_of(const std::vector<CommandHelp>&);

/// Completion of command lines for "bash", "zsh" or "fish".
std::string completion_for(const std::string& shell, const std::vector<CommandHelp>&);

}  // namespace cli
