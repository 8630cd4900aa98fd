// crashreel fit SCENE -o DIR: which inputs explain the evidence, and how sure is that.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/inference/best_scene.h"
#include "cli/inference/fit.h"
#include "cli/inference/search.h"
#include "cli/output/json.h"
#include "cli/output/whole_file.h"
#include "cli/parse.h"
#include "cli/scene_run.h"
#include "cli/study/pool.h"

namespace cli {
namespace {

struct FitWish {
  SceneArguments scene;
  std::string folder, runs = "2000", seed = "1", jobs, calibrate;
  std::vector<std::string> but_for;
  bool overwrite = false;
};

constexpr int kMostRuns = 1'000'000;
constexpr int kButForRuns = 400;

void refuse_empty(const scenes::Scene& scene) {
  if (scene.inference.uncertain.empty())
    throw UsageError(
        fmt::format("{}: nothing is uncertain; add [[uncertain]] with a key and what is known of it", scene.path.string()));
  if (scene.inference.evidence.empty())
    throw UsageError(
        fmt::format("{}: there is no evidence; add [[evidence]] with a metric, a value and a tolerance", scene.path.string()));
}

/// Equally probable runs of the posterior, once more with the change.
inference::ButFor but_for(const inference::Prior& prior, const inference::Fit& fit, inference::Ensemble& ensemble,
                          const std::string& change) {
  if (change.find('=') == std::string::npos)
    throw UsageError(fmt::format("--but-for is \"{}\": must be KEY=VALUE, like vehicle.sedan.speed=\"30 km/h\"", change));
  if (fit.posterior.effective < inference::kEnoughRuns) {
    inference::ButFor none;
    none.change = change;
    none.unanswered = fmt::format("too few effective runs ({:.0f}) carry the posterior", fit.posterior.effective);
    return none;
  }
  std::vector<std::vector<std::string>> changed;
  std::vector<inference::Answer> before;
  for (const std::size_t r : inference::drawn(fit.posterior, kButForRuns)) {
    if (!fit.table.rows[r].answer.ok()) continue;
    before.push_back(fit.table.rows[r].answer);
    changed.push_back(prior.overrides(fit.table.rows[r].values));
    changed.back().push_back(change);
  }
  return inference::compare(change, before, ensemble.run(changed, "but for"));
}

std::string best_scene(const scenes::Scene& scene, const inference::Prior& prior, const inference::Fit& fit) {
  std::vector<std::string> overrides = scene.overrides;
  for (const std::string& text : prior.overrides(fit.table.rows[fit.best].values)) overrides.push_back(text);
  return inference::with_overrides(scene, overrides,
                                   fmt::format("# Written by crashreel fit: of {} runs the one nearest to the evidence, {:.3g} "
                                               "tolerances off. It is one run among many\n"
                                               "# that explain the evidence; the answer is the interval, not this.\n",
                                               fit.table.rows.size(), fit.best_misfit));
}

int run(const FitWish& wish) {
  const scenes::Scene scene = load_scene(wish.scene);
  plan_of(scene);  // refuses effects that do not exist
  refuse_empty(scene);
  const inference::Prior prior(scene.inference.uncertain);
  inference::SearchWish search;
  search.runs = parse_integer("-n", wish.runs, 2, kMostRuns);
  search.seed = static_cast<std::uint64_t>(parse_integer("--seed", wish.seed, 0, 1'000'000'000));
  const int jobs = wish.jobs.empty() ? study::available_cores() : parse_integer("--jobs", wish.jobs, 1, 1024);
  const int cases = wish.calibrate.empty() ? 0 : parse_integer("--calibrate", wish.calibrate, 10, 100'000);
  // refused before the work, not after it
  for (const std::string& change : wish.but_for) scenes::variant(scene, {change});
  const std::filesystem::path folder = wish.folder;
  make_writable_folder(folder);
  for (const char* name : {"posterior.csv", "fit.json", "best.toml", "fit.pdf", "fit.svg", "fit.png"})
    refuse_existing(folder / name, wish.overwrite);
  const inference::FolderLock lock(folder);

  inference::Ensemble ensemble(scene, {folder, jobs, progress_of(wish.scene), "fit", ""});
  inference::Search found = inference::search(scene, prior, ensemble, search);
  std::vector<inference::Calibration> calibrations;
  if (cases > 0) {
    inference::Table plan;
    plan.rows.assign(found.table.rows.begin(), found.table.rows.begin() + static_cast<std::ptrdiff_t>(found.from_prior));
    calibrations = inference::calibrate(prior, scene.inference.evidence, plan, cases, search.seed);
  }
  const inference::Fit fit =
      inference::conclude(prior, scene.inference.evidence, std::move(found.table), std::move(found.log_ratios), search.seed);
  std::vector<inference::ButFor> others;
  for (const std::string& change : wish.but_for) others.push_back(but_for(prior, fit, ensemble, change));

  write_whole(folder / "posterior.csv", inference::posterior_csv(prior, scene.inference.evidence, fit));
  write_whole(folder / "best.toml", best_scene(scene, prior, fit));
  const auto json = inference::fit_json(scene, prior, fit, others, calibrations);
  write_whole(folder / "fit.json", json_text(json) + "\n");
  render::charts::write_page(inference::fit_page(scene, prior, fit, others), folder / "fit");
  if (wish.scene.json) {
    fmt::print("{}\n", json_text(json));
    return kDone;
  }
  for (const std::string& line : inference::sentences(scene, prior, fit, others)) fmt::print("{}\n", line);
  for (const inference::Calibration& c : calibrations)
    fmt::print(
        "{}: of {} cases with known truth the 90 % interval holds it in {}; ranks chi-squared {:.1f} (limit 21.7); {:.0f} "
        "effective runs "
        "in the middle\n",
        c.key, c.cases, c.inside_90, c.chi_squared, c.median_effective);
  fmt::print("{}: posterior.csv, fit.json, best.toml, fit.pdf, fit.svg, fit.png; finished runs in {}\n", wish.folder,
             (folder / "runs").string());
  return kDone;
}

}  // namespace

std::function<int()> declare_fit(Arguments& arguments) {
  const auto wish = std::make_shared<FitWish>();
  declare_scene_file(arguments, wish->scene);
  declare_progress(arguments, wish->scene);
  arguments.required_option("-o,--output", wish->folder, "DIR",
                            "folder for the results; made if missing. Finished runs stay in DIR/runs");
  arguments.option("-n,--runs", wish->runs, "N",
                   "runs at most (default 2000); the first half are those that `crashreel sample` draws");
  arguments.option("--seed", wish->seed, "S", "seed of the random numbers that the inputs are drawn by (default 1)");
  arguments.repeatable("--but-for", wish->but_for, "KEY=VALUE",
                       "what if: would they have met, and how hard: vehicle.sedan.speed=\"30 km/h\"");
  arguments.option("--calibrate", wish->calibrate, "N", "hold intervals against N cases with known truth, from the same runs");
  arguments.option("--jobs", wish->jobs, "N", "runs side by side (default: every core); the numbers do not depend on it");
  arguments.flag("--overwrite", wish->overwrite, "replace results that exist; finished runs are used again");
  return [wish] { return run(*wish); };
}

}  // namespace cli
