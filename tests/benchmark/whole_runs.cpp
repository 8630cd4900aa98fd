#include "tests/benchmark/whole_runs.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <thread>
#include <utility>
#include <vector>

#include "engine/simulate.h"
#include "scenes/loader/builder.h"
#include "scenes/scene.h"

namespace benchmark {
namespace {

using engine::Model;
using engine::Recording;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Seconds of processor time so far, of all threads: a shared host does not change them much.
double worked() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

Model scene(const char* file) {
  return scenes::load(scenes::home_folder() / file).model;
}

Model flagship() {
  return scene("scenes/cases/sedan_pedestrian_40kmh.toml");
}

/// The heap that has come to rest, which a run that ends with the fall does not see.
Model lying_on() {
  Model model = scene("tests/hard_cases/heap_of_three.toml");
  model.settings.duration = 10;
  return model;
}

}  // namespace

void whole_runs() {
  const std::pair<const char*, Model> runs[] = {{"flagship", flagship()},
                                                {"three persons on each other", scene("tests/hard_cases/heap_of_three.toml")},
                                                {"the same, lying on", lying_on()},
                                                {"ten persons falling on a heap", scene("tests/hard_cases/heap_of_ten.toml")}};
  for (const auto& [name, model] : runs) {
    double least = std::numeric_limits<double>::infinity();
    Recording run;
    for (int k = 0; k < 3; ++k) {
      const double start = worked();
      run = engine::simulate(model);
      least = std::min(least, worked() - start);
    }
    const auto& d = run.diagnostics;
    std::printf(
        "%-30s %.2f s in %.3f s of one core, %.2f times real time; %.1f sweeps and %.1f Newton steps a step, residual %.1e m/s\n",
        name, run.end_time(), least, run.end_time() / least, static_cast<double>(d.contact_sweeps) / static_cast<double>(run.steps),
        static_cast<double>(d.newton_steps) / static_cast<double>(run.steps), d.max_solver_residual);
    std::fflush(stdout);
  }
  std::printf("\n");
}

void throughput() {
  constexpr int kRuns = 1000, kCores = 2;
  const Model pedestrian = flagship();
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int k = next++; k < kRuns; k = next++) {
      Model model = pedestrian;
      const double across = 0.3 * std::sin(0.7 * k), faster = 1 + 0.1 * std::sin(1.3 * k);
      for (const int b : model.persons.front().bodies) model.bodies[b].X_WB.p.y() += across;
      model.bodies[model.vehicles.front().body].V_WB.v *= faster;
      engine::simulate(model);
    }
  };
  const double start = seconds(), cpu = worked();
  std::vector<std::thread> cores;
  for (int c = 0; c < kCores; ++c) cores.emplace_back(work);
  for (std::thread& core : cores) core.join();
  const double wall = seconds() - start, each = (worked() - cpu) / kRuns;
  std::printf(
      "%d variants of the flagship on %d cores: %.1f runs a second; %.3f s of processor time each, %.1f a second had both cores "
      "been free\n\n",
      kRuns, kCores, kRuns / wall, each, kCores / each);
}

}  // namespace benchmark
