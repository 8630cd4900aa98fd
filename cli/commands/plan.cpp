// crashreel plan SCENE: which physical effects the scene calls for, and why; which it does not.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/output/summary.h"
#include "cli/scene_run.h"

namespace cli {
namespace {

void print_columns(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i == widths.size()) widths.push_back(0);
      widths[i] = std::max(widths[i], row[i].size());
    }
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) line += fmt::format("{:<{}}  ", row[i], widths[i]);
    fmt::print("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
  }
}

int plan(const SceneArguments& wish) {
  const scenes::Scene scene = load_scene(wish);
  const engine::Plan plan = plan_of(scene);
  if (wish.json) {
    fmt::print("{}\n", plan_json(plan.lines).dump(2));
    return kDone;
  }
  std::vector<std::vector<std::string>> rows = {{"effect", "", "", "why", "what is left out, and what that is worth"}};
  for (const engine::PlanLine& line : plan.lines)
    rows.push_back({line.effect, line.active ? "on" : "off", line.forced ? "forced" : "auto", line.reason,
                    line.left_out.empty() ? "nothing" : line.left_out});
  print_columns(rows);
  for (const std::string& warning : scene.stage.warnings) fmt::print("warning: {}\n", warning);
  return kDone;
}

}  // namespace

std::function<int()> declare_plan(Arguments& arguments) {
  const auto wish = std::make_shared<SceneArguments>();
  declare_scene(arguments, *wish);
  return [wish] { return plan(*wish); };
}

}  // namespace cli
