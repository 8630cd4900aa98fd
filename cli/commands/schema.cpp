// crashreel schema: the JSON Schema of the scene format, so that editors complete and check.
#include <fmt/format.h>

#include "cli/command.h"
#include "cli/exit.h"
#include "scenes/scene.h"

namespace cli {

std::function<int()> declare_schema(Arguments&) {
  return [] {
    fmt::print("{}\n", scenes::json_schema());
    return static_cast<int>(kDone);
  };
}

}  // namespace cli
