// crashreel check SCENE...: reads scenes and reports every error of every one of them.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/findings.h"
#include "cli/foresight.h"
#include "cli/output/json.h"
#include "cli/scene_run.h"
#include "scenes/scene.h"

namespace cli {
namespace {

struct CheckWish {
  std::vector<std::string> scenes;
  std::vector<std::string> set;
  std::vector<std::string> allow;
  std::string output;
  bool json = false;
  bool quiet = false;
};

struct Verdict {
  std::string scene;
  std::vector<scenes::Finding> errors;
  std::vector<scenes::Finding> warnings;
};

Verdict verdict_of(const std::string& file, const CheckWish& wish) {
  Verdict out{file, {}, {}};
  try {
    const scenes::Scene scene = scenes::load(scenes::read_scene_file(file, {wish.allow.begin(), wish.allow.end()}), wish.set);
    for (const std::string& warning : scene.warnings) out.warnings.push_back(finding_of(warning, "odd"));
    for (const std::string& taken : scene.assumed) out.warnings.push_back(finding_of(taken, "assumed"));
    for (const std::string& sentence : foresee(scene, wish.output)) out.warnings.push_back({file, 0, 0, "foreseen", sentence});
  } catch (const scenes::SceneErrors& found) {
    out.errors = found.findings;
  }
  return out;
}

nlohmann::ordered_json as_json(const std::vector<scenes::Finding>& findings) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const scenes::Finding& finding : findings) out.push_back(finding_json(finding));
  return out;
}

int check(const CheckWish& wish) {
  bool all_good = true;
  nlohmann::ordered_json verdicts = nlohmann::ordered_json::array();
  for (const std::string& file : wish.scenes) {
    const Verdict verdict = verdict_of(file, wish);
    const bool good = verdict.errors.empty();
    all_good = all_good && good;
    verdicts.push_back(
        {{"scene", file}, {"ok", good}, {"errors", as_json(verdict.errors)}, {"warnings", as_json(verdict.warnings)}});
    if (wish.json) continue;
    for (const scenes::Finding& error : verdict.errors) fmt::print(stderr, "{}", finding_text(error));
    for (const scenes::Finding& warning : verdict.warnings) {
      if (!wish.quiet) fmt::print(stderr, "{}", finding_text(warning));
    }
    if (good && !wish.quiet) fmt::print("{}: OK{}\n", file, verdict.warnings.empty() ? "" : ", with warnings");
  }
  if (wish.json) fmt::print("{}\n", json_text(verdicts));
  return all_good ? kDone : kAuthorErred;
}

}  // namespace

std::function<int()> declare_check(Arguments& arguments) {
  const auto wish = std::make_shared<CheckWish>();
  arguments.positionals("SCENE", wish->scenes, "scene files (TOML)");
  arguments.repeatable("--set", wish->set, "PATH=VALUE", "change a value of every scene before checking");
  arguments.option("-o,--output", wish->output, "OUT",
                   "where a film would go: whether its disk has room (default: as render has it)");
  declare_allow(arguments, wish->allow);
  arguments.flag("--json", wish->json, "print the verdicts as JSON");
  arguments.flag("-q,--quiet", wish->quiet, "errors only");
  return [wish] { return check(*wish); };
}

}  // namespace cli
