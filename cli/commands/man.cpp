// crashreel man [COMMAND]: manual pages, made from the table of commands.
#include <fmt/format.h>

#include <memory>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/help.h"

namespace cli {
namespace {

int man(const std::string& name) {
  const std::vector<CommandHelp> all = help_of_commands();
  if (name.empty()) {
    fmt::print("{}", man_page_of(all));
    return kDone;
  }
  for (const CommandHelp& help : all) {
    if (help.command->name != name) continue;
    fmt::print("{}", man_page_of(help));
    return kDone;
  }
  refuse_command(name);
}

}  // namespace

std::function<int()> declare_man(Arguments& arguments) {
  const auto name = std::make_shared<std::string>();
  arguments.option("--page", *name, "COMMAND", "the page of this command, also as crashreel man COMMAND; left out: of the program");
  return [name] { return man(*name); };
}

}  // namespace cli
