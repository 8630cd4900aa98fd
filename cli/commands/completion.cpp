// crashreel completion SHELL: completes command lines in bash, zsh and fish.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/help.h"

namespace cli {

std::function<int()> declare_completion(Arguments& arguments) {
  const auto shell = std::make_shared<std::string>();
  arguments.positional("SHELL", *shell, "bash, zsh or fish");
  return [shell]() -> int {
    constexpr const char* kShells[] = {"bash", "zsh", "fish"};
    if (std::none_of(std::begin(kShells), std::end(kShells), [&shell](const char* known) { return *shell == known; }))
      throw UsageError(fmt::format("crashreel completion: \"{}\" is none of bash, zsh, fish", *shell));
    fmt::print("{}", completion_for(*shell, help_of_commands()));
    return kDone;
  };
}

}  // namespace cli
