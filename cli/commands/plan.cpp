// crashreel plan SCENE: which physical effects the scene calls for, and why; which it does not; with --measure what each costs.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/output/json.h"
#include "cli/output/summary.h"
#include "cli/scene_run.h"

namespace cli {
namespace {

using Rows = std::vector<std::vector<std::string>>;

struct PlanWish {
  SceneArguments scene;
  bool measure = false;
};

/// What an effect or a part of the step cost in a run.
struct Cost {
  long calls = 0;
  double us_per_step = 0;
  double share = 0;  // of the run
};

Cost cost_of(const engine::Recording& run, const std::vector<engine::EffectCost>& costs, const std::string& name) {
  double all = 0;
  for (const auto* list : {&run.costs, &run.phases})
    for (const engine::EffectCost& cost : *list) all += cost.wall_s;
  for (const engine::EffectCost& cost : costs) {
    if (cost.effect != name) continue;
    const double steps = std::max(1.0, static_cast<double>(run.steps));
    return {cost.calls, 1e6 * cost.wall_s / steps, all > 0 ? cost.wall_s / all : 0};
  }
  return {};
}

const char* words_of_phase(const std::string& phase) {
  if (phase == "integration") return "smooth motion in four stages, joints solved in each";
  if (phase == "impulses") return "contacts, limits, wheels and joint resistance in one solve";
  if (phase == "joint_projection") return "drift of the joints taken out";
  if (phase == "recording") return "snapshots, events and energies";
  return "the step's own housekeeping and the start of the run";
}

constexpr std::size_t kTerminal = 80;  // columns
constexpr std::size_t kWidest = 32;    // of a column of the table of phases
constexpr std::size_t kEffect = 18, kState = 7;

/// The text in lines of at most `widest`, broken at spaces.
std::vector<std::string> broken(std::string text, std::size_t widest) {
  std::vector<std::string> out;
  while (text.size() > widest) {
    const std::size_t at = text.rfind(' ', widest);
    if (at == std::string::npos || at == 0) break;
    out.push_back(text.substr(0, at));
    text.erase(0, at + 1);
  }
  out.push_back(text);
  return out;
}

/// Beside the name and the state, as wide as a terminal is.
void print_paragraph(const std::string& name, const std::string& state, const std::string& text) {
  std::string head = fmt::format("{:<{}}{:<{}}", name, kEffect, state, kState);
  for (const std::string& line : broken(text, kTerminal - kEffect - kState)) {
    fmt::print("{}{}\n", head, line);
    head.assign(kEffect + kState, ' ');
  }
}

void print_columns(const Rows& rows) {
  std::vector<std::vector<std::vector<std::string>>> cells;  // by row and column, in lines
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    cells.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i == widths.size()) widths.push_back(0);
      cells.back().push_back(broken(row[i], kWidest));
      for (const std::string& line : cells.back().back()) widths[i] = std::max(widths[i], line.size());
    }
  }
  for (const auto& row : cells) {
    std::size_t lines = 0;
    for (const auto& cell : row) lines = std::max(lines, cell.size());
    for (std::size_t l = 0; l < lines; ++l) {
      std::string line;
      for (std::size_t i = 0; i < row.size(); ++i) line += fmt::format("{:<{}}  ", l < row[i].size() ? row[i][l] : "", widths[i]);
      fmt::print("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
    }
  }
}

std::vector<std::string> words_of(const Cost& cost) {
  return {fmt::format("{:>8}", cost.calls), fmt::format("{:>7.2f}", cost.us_per_step), fmt::format("{:>5.1f} %", 100 * cost.share)};
}

/// "on", "waits" where it is proved that it cannot matter up to `now` [s], and what a run has seen of it.
std::string words_of_state(const engine::PlanLine& line, double now) {
  if (!line.active) return "off";
  if (line.acted.told) return line.acted.in_reach < 0 ? "waited" : "on";
  return line.not_before > now ? "waits" : "on";
}

/// The proof before a run, and what the run saw.
std::string words_of_reason(const engine::PlanLine& line) {
  std::string out = line.reason;
  if (line.active && line.not_before > 0) out += fmt::format("; not before t = {:.3g} s", line.not_before);
  if (!line.acted.told) return out;
  if (line.acted.first >= 0) return out + fmt::format("; acted from {:.4g} to {:.4g} s", line.acted.first, line.acted.last);
  if (line.acted.in_reach >= 0) return out + fmt::format("; near from {:.4g} s, never acted", line.acted.in_reach);
  return out + "; nothing ever came into its reach";
}

void print_plan(const std::vector<engine::PlanLine>& lines, const engine::Recording* run) {
  const double now = run ? run->end_time() : 0;
  for (const engine::PlanLine& line : lines) {
    print_paragraph(line.effect, words_of_state(line, now), (line.forced ? "forced: " : "") + words_of_reason(line));
    if (!line.left_out.empty()) print_paragraph("", "", "left out: " + line.left_out);
    if (!run || !line.active) continue;
    const Cost cost = cost_of(*run, run->costs, line.effect);
    print_paragraph("", "",
                    fmt::format("cost: {} calls, {:.2f} us/step, {:.1f} %", cost.calls, cost.us_per_step, 100 * cost.share));
  }
  if (!run) return;

  Rows rows = {{"for all effects", "   calls", "us/step", "  share", ""}};
  double all = 0;
  for (const engine::EffectCost& cost : run->costs) all += cost_of(*run, run->costs, cost.effect).us_per_step;
  for (const engine::EffectCost& phase : run->phases) {
    const Cost cost = cost_of(*run, run->phases, phase.effect);
    all += cost.us_per_step;
    std::vector<std::string> row = words_of(cost);
    row.insert(row.begin(), phase.effect);
    row.push_back(words_of_phase(phase.effect));
    rows.push_back(row);
  }
  fmt::print("\n");
  print_columns(rows);
  fmt::print("\n{} steps, {:.2f} us each, {:.4g} s simulated\n", run->steps, all, run->end_time());
}

Json measured_json(const engine::Recording& run) {
  const auto with = [](Json line, const Cost& cost) {
    line["calls"] = cost.calls;
    line["us_per_step"] = cost.us_per_step;
    line["share"] = cost.share;
    return line;
  };
  Json out;
  for (const Json& line : plan_json(run.plan)) out["plan"].push_back(with(line, cost_of(run, run.costs, line["effect"])));
  for (const engine::EffectCost& phase : run.phases)
    out["phases"].push_back(with({{"phase", phase.effect}}, cost_of(run, run.phases, phase.effect)));
  out["steps"] = run.steps;
  out["simulated_s"] = run.end_time();
  return out;
}

int plan(const PlanWish& wish) {
  const scenes::Scene scene = load_scene(wish.scene);
  const engine::Plan plan = plan_of(scene);
  if (wish.measure) {
    const engine::Recording run = run_scene(scene, plan, wish.scene, Costs::timed);
    if (wish.scene.json) {
      fmt::print("{}\n", json_text(measured_json(run)));
    } else {
      print_plan(run.plan, &run);
      for (const std::string& warning : run.diagnostics.warnings) fmt::print("warning: {}\n", warning);
    }
    return exit_code_of(run);
  }
  if (wish.scene.json) {
    fmt::print("{}\n", json_text(plan_json(plan.lines)));
    return kDone;
  }
  print_plan(plan.lines, nullptr);
  if (const std::string scheme = scheme_in_words(scene.model, plan); !scheme.empty()) print_paragraph("scheme", "", scheme);
  for (const std::string& taken : scene.assumed) print_paragraph("assumed", "", taken);
  for (const std::string& warning : scene.stage.warnings) fmt::print("\nwarning: {}\n", warning);
  return kDone;
}

}  // namespace

std::function<int()> declare_plan(Arguments& arguments) {
  const auto wish = std::make_shared<PlanWish>();
  declare_scene(arguments, wish->scene);
  declare_progress(arguments, wish->scene);
  arguments.flag("--measure", wish->measure,
                 "run the scene and tell calls, microseconds a step and share of the run of each effect");
  return [wish] { return plan(*wish); };
}

}  // namespace cli
