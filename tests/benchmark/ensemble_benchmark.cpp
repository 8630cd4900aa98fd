// What a run of an ensemble costs beyond its steps: `benchmark_ensemble SCENE [runs]`. Bare runs (simulate a model that is loaded
// already) and whole ones (load the variant, simulate, measure, write the line of the journal) of the same variants take turns, in
// time of the processor; then the same ensemble by processes, on the clock, with the memory of the parent.
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>

#include "cli/inference/ensemble.h"
#include "cli/inference/prior.h"
#include "cli/inference/sample.h"
#include "engine/plan.h"
#include "engine/simulate.h"

namespace {

using namespace cli::inference;

double seconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <class Work>
double processor_time(const Work& work) {
  const double from = seconds(CLOCK_PROCESS_CPUTIME_ID);
  work();
  return seconds(CLOCK_PROCESS_CPUTIME_ID) - from;
}

double peak_megabytes() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_maxrss) / 1024;
}

std::vector<std::vector<std::string>> variants(const scenes::Scene& scene, int count, std::uint64_t seed) {
  const Prior prior(scene.inference.uncertain);
  const Table plan = plan_rows(prior, {}, static_cast<std::uint64_t>(count), seed);
  std::vector<std::vector<std::string>> out;
  for (const Row& row : plan.rows) out.push_back(overrides_of(prior, plan, row));
  return out;
}

void overhead(const scenes::Scene& scene, int count) {
  double bare = 0, loading = 0, whole = 0;
  for (const auto& overrides : variants(scene, count, 1)) {
    std::optional<scenes::Scene> variant;
    loading += processor_time([&] { variant = scenes::variant(scene, overrides); });
    bare += processor_time([&] { engine::simulate(variant->model, engine::compile(variant->model)); });
    whole += processor_time([&] { as_line("", answer(scene, overrides)); });
  }
  fmt::print(
      "{} runs one after the other: bare {:.1f} ms, whole {:.1f} ms a run, of which loading {:.2f} ms: {:+.1f} % over bare\n",
      count, 1e3 * bare / count, 1e3 * whole / count, 1e3 * loading / count, 100 * (whole / bare - 1));
}

void crew(const scenes::Scene& scene, int count, int jobs) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("crashreel_ensemble_{}", count);
  std::filesystem::remove_all(folder);
  const double before = peak_megabytes(), from = seconds(CLOCK_MONOTONIC);
  Ensemble(scene, {folder, jobs, cli::ShowProgress::never, "run", ""}).run(variants(scene, count, 1));
  const double time = seconds(CLOCK_MONOTONIC) - from;
  fmt::print("{} runs by {} processes: {:.1f} s, {:.0f} s for 1,000; memory of the parent {:.0f} MB, {:+.1f} MB by the runs\n",
             count, jobs, time, 1e3 * time / count, peak_megabytes(), peak_megabytes() - before);
  std::filesystem::remove_all(folder);
}

}  // namespace

int main(int argc, char** argv) try {
  const scenes::Scene scene = scenes::load(std::filesystem::path(argc > 1 ? argv[1] : "scenes/cases/sedan_pedestrian_fit.toml"));
  const int count = argc > 2 ? std::atoi(argv[2]) : 32;
  overhead(scene, count);
  crew(scene, count, 2);
  crew(scene, 4 * count, 2);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
