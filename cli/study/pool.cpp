#include "cli/study/pool.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>
#include <numeric>

#include "cli/exit.h"

namespace cli::study {
namespace {

struct Worker {
  std::size_t trial = 0;
  int core = 0;
};

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

/// In the child: stays on its core, ends with the parent, never returns.
[[noreturn]] void work(const Trial& trial, const std::filesystem::path& file, int core) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(core, &set);
  sched_setaffinity(0, sizeof set, &set);  // a core more or less is no reason to fail
  int code = 0;
  try {
    store(run(trial), file);
  } catch (const std::exception& error) {
    fmt::print(stderr, "crashreel: {}\n", error.what());
    code = 1;
  }
  std::fflush(stderr);
  _exit(code);
}

void stop(const std::map<pid_t, Worker>& running) {
  for (const auto& [pid, worker] : running) kill(pid, SIGTERM);
  for (const auto& [pid, worker] : running) waitpid(pid, nullptr, 0);
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

  std::vector<int> idle = cores();
  idle.resize(std::min<std::size_t>(idle.size(), std::max(1, jobs)));
  std::map<pid_t, Worker> running;
  std::fflush(nullptr);
  while (!waiting.empty() || !running.empty()) {
    while (!waiting.empty() && !idle.empty()) {
      const std::size_t i = waiting.back();
      const int core = idle.back();
      const pid_t pid = fork();
      if (pid == 0) work(trials[i], file_of(i), core);
      if (pid < 0) {
        const int why = errno;
        stop(running);
        throw MachineError(fmt::format("starting a worker of the study: {}", std::strerror(why)));
      }
      waiting.pop_back();
      idle.pop_back();
      running[pid] = {i, core};
    }
    int status = 0;
    const pid_t pid = waitpid(-1, &status, 0);
    if (pid < 0 && errno == EINTR) continue;
    if (pid < 0) throw MachineError(fmt::format("waiting for a worker of the study: {}", std::strerror(errno)));
    const auto found = running.find(pid);
    if (found == running.end()) continue;
    const Worker worker = found->second;
    running.erase(found);
    idle.push_back(worker.core);
    if (!recall(file_of(worker.trial), outcomes[worker.trial])) {
      stop(running);
      throw MachineError(fmt::format("a run of the study ended without a result ({}); trials done so far are kept in {}",
                                     fmt::join(trials[worker.trial].overrides, ", "), folder.string()));
    }
    done += trials[worker.trial].cost;
    progress.at(done);
  }
  progress.finish(done);
  return outcomes;
}

}  // namespace cli::study
