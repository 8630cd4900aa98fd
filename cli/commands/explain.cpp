// crashreel explain NAME: what a measure, an effect or a column means.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/output/json.h"
#include "engine/effects/effect.h"
#include "engine/measure/definitions.h"
#include "scenes/loader/value.h"

namespace cli {
namespace {

nlohmann::ordered_json as_json(const engine::Definition& d) {
  return {{"name", d.key},      {"unit", d.unit},        {"title", d.title}, {"definition", d.definition},
          {"absent", d.absent}, {"sureness", d.sureness}};
}

std::string as_text(const engine::Definition& d) {
  return fmt::format("{}{}{}{}\n  {}\n  Absent: {}.\n  How sure: {}.\n", d.key, *d.unit ? " [" : "", d.unit, *d.unit ? "]" : "",
                     d.definition, d.absent, d.sureness);
}

/// One line a measure, as the reference has it.
void print_table() {
  fmt::print("| measure | unit | definition | absent | how sure |\n|---|---|---|---|---|\n");
  for (const engine::Definition& d : engine::definitions())
    fmt::print("| `{}` | {} | {} | {} | {} |\n", d.key, d.unit, d.definition, d.absent, d.sureness);
}

int explain(const std::string& name, bool json) {
  if (name == "all") {
    if (!json) return print_table(), kDone;
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const engine::Definition& d : engine::definitions()) all.push_back(as_json(d));
    fmt::print("{}\n", json_text(all));
    return kDone;
  }
  std::vector<std::string> names;
  for (const engine::Definition& d : engine::definitions()) {
    names.emplace_back(d.key);
    // as in a scene's [expect]: with or without its unit
    if (d.key != name && !(*d.unit && std::string(d.key).starts_with(name + "_"))) continue;
    fmt::print("{}", json ? json_text(as_json(d)) + "\n" : as_text(d));
    return kDone;
  }
  const std::string near = scenes::nearest(name, names);
  throw UsageError(fmt::format("{} is no measure{}; \"all\" lists them", name,
                               near.empty() ? std::string() : fmt::format("; did you mean {}?", near)));
}

}  // namespace

std::function<int()> declare_explain(Arguments& arguments) {
  const auto name = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  arguments.positional("NAME", *name, "key of a measure in summary.json; all: every one, as a table");
  arguments.flag("--json", *json, "print as JSON");
  return [name, json] { return explain(*name, *json); };
}

}  // namespace cli
