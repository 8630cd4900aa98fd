// crashreel sample SCENE -n N -o DIR: what follows from what is not known.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/inference/rest.h"
#include "cli/inference/sample.h"
#include "cli/output/json.h"
#include "cli/output/whole_file.h"
#include "cli/parse.h"
#include "cli/scene_run.h"
#include "cli/study/pool.h"

namespace cli {
namespace {

struct SampleWish {
  SceneArguments scene;
  std::string folder, runs, seed = "1", jobs, part;
  std::vector<std::string> grid;
  bool overwrite = false;
};

constexpr int kMostRuns = 10'000'000;
constexpr int kMostParts = 100'000;

/// "K/N" of --part; {1, 1} where it is not given.
struct Part {
  int number = 1, of = 1;
  std::string name() const { return of == 1 ? "" : fmt::format("{}-of-{}", number, of); }
};

Part part_of(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos)
    throw UsageError(fmt::format("--part is \"{}\": must be K/N, like 3/8 for the third of eight jobs", text));
  Part out;
  out.of = parse_integer("--part", text.substr(slash + 1), 1, kMostParts);
  out.number = parse_integer("--part", text.substr(0, slash), 1, out.of);
  return out;
}

/// Every N-th run of the plan into a journal of its own; results are for the job that joins the parts.
int run_part(const scenes::Scene& scene, const SampleWish& wish, const Part& part, const std::vector<std::vector<std::string>>& all,
             int jobs) {
  std::vector<std::vector<std::string>> mine;
  for (std::size_t i = static_cast<std::size_t>(part.number - 1); i < all.size(); i += static_cast<std::size_t>(part.of))
    mine.push_back(all[i]);
  inference::Ensemble ensemble(scene, {wish.folder, jobs, progress_of(wish.scene), "sample", part.name()});
  ensemble.run(mine);
  if (!wish.scene.quiet)
    fmt::print("part {} of {}: {} of {} runs are done; the same command without --part joins them\n", part.number, part.of,
               mine.size(), all.size());
  return kDone;
}

/// A key none of whose values the scene takes is a slip, refused before the work; single ones may be rows with their reason.
void refuse_slips(const scenes::Scene& scene, const std::vector<inference::GridAxis>& grid) {
  for (const inference::GridAxis& axis : grid) {
    std::string problem;
    for (const std::string& value : axis.values) {
      try {
        scenes::variant(scene, {axis.key + "=" + value});
        problem.clear();
        break;
      } catch (const scenes::SceneErrors& errors) {
        if (problem.empty()) problem = errors.findings.front().what;
      }
    }
    if (!problem.empty()) throw UsageError(fmt::format("--grid {}={}: {}", axis.key, axis.values.front(), problem));
  }
}

int run(const SampleWish& wish) {
  const scenes::Scene scene = load_scene(wish.scene);
  plan_of(scene);  // refuses effects that do not exist
  const inference::Prior prior(scene.inference.uncertain);
  std::vector<inference::GridAxis> grid;
  for (const std::string& text : wish.grid) grid.push_back(inference::parse_grid(text));
  const int count = wish.runs.empty() ? (grid.empty() ? 256 : 0) : parse_integer("-n", wish.runs, 1, kMostRuns);
  if (prior.size() == 0 && grid.empty())
    throw UsageError(
        fmt::format("{}: nothing is uncertain; add [[uncertain]] with a key and what is known of it, or give --grid KEY=VALUES",
                    scene.path.string()));
  const int seed = parse_integer("--seed", wish.seed, 0, 1'000'000'000);
  const int jobs = wish.jobs.empty() ? study::available_cores() : parse_integer("--jobs", wish.jobs, 1, 1024);
  const Part part = part_of(wish.part);
  refuse_slips(scene, grid);
  const std::filesystem::path folder = wish.folder;
  make_writable_folder(folder);
  if (part.of == 1)
    for (const char* name : {"runs.csv", "sample.json", "sample.pdf", "sample.svg", "sample.png", "rest_cloud.pdf",
                             "rest_cloud.svg", "rest_ghosts.png"})
      refuse_existing(folder / name, wish.overwrite);
  const inference::FolderLock lock(folder, part.name());

  inference::Table table = inference::plan_rows(prior, grid, static_cast<std::uint64_t>(count), static_cast<std::uint64_t>(seed));
  std::vector<std::vector<std::string>> overrides;
  for (const inference::Row& row : table.rows) overrides.push_back(inference::overrides_of(prior, table, row));
  if (part.of > 1) return run_part(scene, wish, part, overrides, jobs);
  inference::Ensemble ensemble(scene, {folder, jobs, progress_of(wish.scene), "sample", ""});
  const std::vector<inference::Answer> answers = ensemble.run(overrides);
  for (std::size_t i = 0; i < answers.size(); ++i) table.rows[i].answer = answers[i];
  inference::judge(scene.inference.evidence, table);

  write_whole(folder / "runs.csv", inference::runs_csv(prior, scene.inference.evidence, table));
  const inference::Sample sample = inference::summarise(scene, prior, std::move(table), static_cast<std::uint64_t>(seed));
  const auto json = inference::sample_json(scene, prior, sample);
  write_whole(folder / "sample.json", json_text(json) + "\n");
  render::charts::write_page(inference::sample_page(scene, prior, sample), folder / "sample");
  std::string rests;
  for (const std::string& file : inference::draw_rests(scene, prior, sample, folder)) rests += ", " + file;
  if (wish.scene.json)
    fmt::print("{}\n", json_text(json));
  else
    fmt::print("{}{}: runs.csv, sample.json, sample.pdf, sample.svg, sample.png{}; finished runs in {}\n",
               inference::sample_text(scene, prior, sample), wish.folder, rests, (folder / "runs").string());
  return kDone;
}

}  // namespace

std::function<int()> declare_sample(Arguments& arguments) {
  const auto wish = std::make_shared<SampleWish>();
  declare_scene_file(arguments, wish->scene);
  declare_progress(arguments, wish->scene);
  arguments.required_option("-o,--output", wish->folder, "DIR",
                            "folder for the results; made if missing. Finished runs stay in DIR/runs");
  arguments.option("-n,--runs", wish->runs, "N", "runs (default 256; powers of two fill the range best)");
  arguments.option("--seed", wish->seed, "S", "seed of the random numbers that the inputs are drawn by (default 1)");
  arguments.repeatable("--grid", wish->grid, "KEY=VALUES",
                       "every one of these values of a key: vehicle.sedan.speed=\"30,40,50 km/h\"");
  arguments.option("--part", wish->part, "K/N",
                   "only every N-th run from the K-th on, for array jobs; the command without it joins the parts in DIR");
  arguments.option("--jobs", wish->jobs, "N", "runs side by side (default: every core); the numbers do not depend on it");
  arguments.flag("--overwrite", wish->overwrite, "replace results that exist; finished runs are used again");
  return [wish] { return run(*wish); };
}

}  // namespace cli
