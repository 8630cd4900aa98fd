// crashreel check SCENE...: reads scenes and reports every error of every one of them.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/exit.h"
#include "scenes/scene.h"

namespace cli {
namespace {

struct CheckWish {
  std::vector<std::string> scenes;
  std::vector<std::string> set;
  bool json = false;
  bool quiet = false;
};

struct Verdict {
  std::string scene;
  std::vector<std::string> errors;
  std::vector<std::string> warnings;
};

Verdict verdict_of(const std::string& file, const std::vector<std::string>& overrides) {
  try {
    return {file, {}, scenes::load(file, overrides).warnings};
  } catch (const scenes::SceneErrors& found) {
    return {file, found.lines, {}};
  }
}

int check(const CheckWish& wish) {
  bool all_good = true;
  nlohmann::ordered_json verdicts = nlohmann::ordered_json::array();
  for (const std::string& file : wish.scenes) {
    const Verdict verdict = verdict_of(file, wish.set);
    const bool good = verdict.errors.empty();
    all_good = all_good && good;
    verdicts.push_back({{"scene", file}, {"ok", good}, {"errors", verdict.errors}, {"warnings", verdict.warnings}});
    if (wish.json) continue;
    for (const std::string& line : verdict.errors) fmt::print(stderr, "{}\n", line);
    for (const std::string& line : verdict.warnings) {
      if (!wish.quiet) fmt::print(stderr, "{}\n", line);
    }
    if (good && !wish.quiet) fmt::print("{}: OK\n", file);
  }
  if (wish.json) fmt::print("{}\n", verdicts.dump(2));
  return all_good ? kDone : kAuthorErred;
}

}  // namespace

std::function<int()> declare_check(Arguments& arguments) {
  const auto wish = std::make_shared<CheckWish>();
  arguments.positionals("SCENE", wish->scenes, "scene files (TOML)");
  arguments.repeatable("--set", wish->set, "PATH=VALUE", "change a value of every scene before checking");
  arguments.flag("--json", wish->json, "print the verdicts as JSON");
  arguments.flag("-q,--quiet", wish->quiet, "errors only");
  return [wish] { return check(*wish); };
}

}  // namespace cli
