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

int plan(const SceneArguments& wish) {
  const scenes::Scene scene = load_scene(wish);
  const engine::Plan plan = plan_of(scene);
  if (wish.json) {
    fmt::print("{}\n", plan_json(plan.lines).dump(2));
    return kDone;
  }
  std::size_t width = 0;
  for (const engine::PlanLine& line : plan.lines) width = std::max(width, line.effect.size());
  for (const engine::PlanLine& line : plan.lines) {
    fmt::print("{:<{}}  {:<3}  {}{}\n", line.effect, width, line.active ? "on" : "off", line.forced ? "forced: " : "", line.reason);
  }
  return kDone;
}

}  // namespace

std::function<int()> declare_plan(Arguments& arguments) {
  const auto wish = std::make_shared<SceneArguments>();
  declare_scene(arguments, *wish);
  return [wish] { return plan(*wish); };
}

}  // namespace cli
