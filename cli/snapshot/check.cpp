#include "cli/snapshot/check.h"

#include <fmt/format.h>
#include <fnmatch.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <thread>

#include "cli/estimate.h"
#include "cli/exit.h"
#include "cli/film_plan.h"
#include "cli/output/json.h"
#include "cli/process.h"
#include "cli/progress.h"
#include "cli/snapshot/baselines.h"
#include "cli/snapshot/judge.h"
#include "engine/address_sanitizer.h"
#include "engine/measure/metrics.h"
#include "engine/simulate.h"
#include "render/painter.h"
#include "render/workers.h"

namespace cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNoMemory = "not enough memory; with fewer --jobs, or more for --max-memory, each scene may take more";
constexpr double kLeastShare = 500e6;  // [byte] for any scene of the library at 1920x1080, twice

/// How many scenes at once, and what each may take.
struct Shares {
  int workers;
  double memory;  // [byte]
};

Shares shares_of(const CheckJob& job, std::size_t scenes) {
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int wanted = std::min(job.workers > 0 ? job.workers : cores, std::max(1, static_cast<int>(scenes)));
  const double machine = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const double all = job.memory > 0 ? job.memory : machine;
  const int fitting = std::clamp(static_cast<int>(std::min(all / kLeastShare, 1e6)), 1, wanted);
  if (fitting < wanted && !job.quiet)
    fmt::print(stderr, "crashreel: {} scene{} at once in place of {}, to stay below {} of memory\n", fitting,
               fitting == 1 ? "" : "s", wanted, bytes_text(all));
  return {fitting, all / fitting};
}

/// Everything about one scene. What it cannot do stands in its errors.
Json check_scene(const fs::path& file, const CheckJob& job) {
  const double start = clock_seconds();
  const fs::path relative = file.lexically_proximate(job.root);
  Json out = {{"scene", relative.string()}, {"title", ""},
              {"names", Json::array()},     {"errors", Json::array()},
              {"pictures", Json::array()},  {"measures", Json::array()}};
  try {
    scenes::Scene scene = scenes::load(scenes::read_scene_file(file, job.allow));
    out["title"] = scene.title;
    std::vector<Still> stills = stills_of(scene);
    for (const Still& still : stills) out["names"].push_back(still.name);
    if (!job.only.empty() && !fits(file.stem().string(), job.only))
      std::erase_if(stills, [&job](const Still& still) { return !fits(still.name, job.only); });
    if (stills.empty() && (!job.only.empty() || scene.snapshot.expectations.empty())) return out;
    scene.stage.provenance.clear();  // version and hash of the scene are no part of the picture
    const engine::Recording run = engine::simulate(scene.model);
    if (run.failure) {
      out["errors"].push_back(fmt::format("the model diverged at {:.4f} s, body {}, effect {}: {}", run.failure->time,
                                          run.failure->body, run.failure->effect, run.failure->message));
    }
    const std::vector<engine::Metric> metrics = engine::measure(scene.model, run);
    for (const scenes::Expectation& expected : scene.snapshot.expectations)
      out["measures"].push_back(judge_measure(expected, metrics));
    // someone who updates by name may want the bits of today even where they are within the limits
    const Keeping keeping{job.report, fs::path("pictures") / relative.parent_path(), !job.only.empty()};
    render::Painter painter(scene.snapshot.width, scene.snapshot.height, quality_of(scene.output.quality));
    render::Image image;
    for (const Still& still : stills) {
      painter.paint(scene.stage, run, still.moment, image);
      out["pictures"].push_back(judge(scene, still, image, keeping));
    }
  } catch (const scenes::SceneErrors& errors) {
    for (const std::string& line : errors.lines) out["errors"].push_back(line);
  } catch (const std::bad_alloc&) {
    out["errors"].push_back(kNoMemory);
  } catch (const std::exception& error) {
    out["errors"].push_back(error.what());
  }
  out["wall_s"] = clock_seconds() - start;
  return out;
}

std::string text_of(const fs::path& scene, const CheckJob& job) {
  return json_text(check_scene(scene, job), -1);
}

/// Libraries that promise not to throw end the process where they find no memory (cli/process.h).
bool out_of_memory(const render::TaskResult& result) {
  return WIFEXITED(result.status) && WEXITSTATUS(result.status) == kMachineFailed;
}

Json collect(const fs::path& scene, const CheckJob& job, const render::TaskResult& result) {
  if (result.status == 0) return Json::parse(result.message);
  return {
      {"scene", scene.lexically_proximate(job.root).string()},
      {"title", ""},
      {"names", Json::array()},
      {"errors",
       {out_of_memory(result) ? kNoMemory : fmt::format("the process that checked it ended: {}", render::ending(result.status))}},
      {"pictures", Json::array()},
      {"measures", Json::array()},
      {"wall_s", 0}};
}

}  // namespace

bool fits(const std::string& name, const std::vector<std::string>& patterns) {
  for (const std::string& pattern : patterns)
    for (const char* ending : {"", ".png", ".toml"})
      if (fnmatch(pattern.c_str(), (name + ending).c_str(), 0) == 0) return true;
  return false;
}

std::vector<SceneReport> check_scenes(const std::vector<fs::path>& scenes, const CheckJob& job,
                                      const std::function<void(int done)>& progress) {
  const Shares shares = shares_of(job, scenes.size());
  render::Workers workers(shares.workers, check_interrupted);
  std::vector<SceneReport> out(scenes.size());
  int done = 0;
  workers.run(
      static_cast<int>(scenes.size()),
      [&](int i, int) {
        // while a mesh is imported there are two processes; a sanitizer's own addresses would count
        if (!engine::kAddressSanitizer) limit_memory(shares.memory / 2);
        return text_of(scenes[static_cast<std::size_t>(i)], job);
      },
      [&](const render::TaskResult& result) {
        const auto scene = static_cast<std::size_t>(result.task);
        out[scene] = collect(scenes[scene], job, result);
        progress(++done);
      });
  return out;
}

}  // namespace cli
