#include "cli/study/pool.h"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>

#include "cli/exit.h"
#include "cli/process.h"
#include "render/workers.h"

namespace cli::study {
namespace {

std::vector<int> cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> out;
  if (sched_getaffinity(0, sizeof set, &set) == 0)
    for (int c = 0; c < CPU_SETSIZE; ++c)
      if (CPU_ISSET(c, &set)) out.push_back(c);
  if (out.empty()) out.push_back(0);
  return out;
}

/// In a process of its own, which stays on its core.
void work(const Trial& trial, const std::filesystem::path& file, int core) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(core, &set);
  sched_setaffinity(0, sizeof set, &set);  // a core more or less is no reason to fail
  store(run(trial), file);
}

}  // namespace

int available_cores() {
  return static_cast<int>(cores().size());
}

std::vector<Outcome> run_all(const std::vector<Trial>& trials, const std::filesystem::path& folder, int jobs, ShowProgress show) {
  const auto file_of = [&](std::size_t i) { return folder / (trials[i].fingerprint.substr(0, 32) + ".json"); };
  std::vector<Outcome> outcomes(trials.size());
  std::vector<std::size_t> waiting;
  for (std::size_t i = 0; i < trials.size(); ++i)
    if (!recall(file_of(i), outcomes[i])) waiting.push_back(i);
  // the longest first: the short ones then fill what is left
  std::stable_sort(waiting.begin(), waiting.end(), [&](std::size_t a, std::size_t b) { return trials[a].cost < trials[b].cost; });
  double total = 0, done = 0;
  for (const std::size_t i : waiting) total += trials[i].cost;
  const bool alike = std::all_of(trials.begin(), trials.end(), [](const Trial& trial) { return trial.cost == 1; });
  Progress progress("study", alike ? "runs" : "steps", total, show);

  const std::vector<int> on = cores();
  std::reverse(waiting.begin(), waiting.end());
  render::Workers workers(std::min(static_cast<int>(on.size()), std::max(1, jobs)), check_interrupted);
  const auto task = [&](int i, int place) {
    const std::size_t trial = waiting[static_cast<std::size_t>(i)];
    work(trials[trial], file_of(trial), on[static_cast<std::size_t>(place)]);
    return std::string();
  };
  workers.run(static_cast<int>(waiting.size()), task, [&](const render::TaskResult& result) {
    const std::size_t trial = waiting[static_cast<std::size_t>(result.task)];
    if (!recall(file_of(trial), outcomes[trial]))
      throw MachineError(fmt::format("a run of the study ended without a result ({}: {}); trials done so far are kept in {}",
                                     fmt::join(trials[trial].overrides, ", "), render::ending(result.status), folder.string()));
    done += trials[trial].cost;
    progress.at(done);
  });
  progress.finish(done);
  return outcomes;
}

}  // namespace cli::study
