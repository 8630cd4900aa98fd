#include "cli/snapshot/check.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cstdlib>
#include <thread>

#include "cli/exit.h"
#include "cli/film_plan.h"
#include "cli/output/json.h"
#include "cli/process.h"
#include "cli/progress.h"
#include "cli/snapshot/baselines.h"
#include "cli/snapshot/judge.h"
#include "engine/measure/metrics.h"
#include "engine/simulate.h"
#include "render/painter.h"
#include "render/workers.h"

namespace cli {
namespace {

namespace fs = std::filesystem;
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
  } catch (const std::exception& error) {
    out["errors"].push_back(error.what());
  }
  out["wall_s"] = clock_seconds() - start;
  return out;
}

std::string text_of(const fs::path& scene, const CheckJob& job) {
  return json_text(check_scene(scene, job), -1);
}

Json collect(const fs::path& scene, const CheckJob& job, const render::TaskResult& result) {
  if (result.status == 0) return Json::parse(result.message);
  return {{"scene", scene.lexically_proximate(job.root).string()},
          {"title", ""},
          {"names", Json::array()},
          {"errors", {fmt::format("the process that checked it ended: {}", render::ending(result.status))}},
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
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  render::Workers workers(job.workers > 0 ? job.workers : cores, check_interrupted);
  std::vector<SceneReport> out(scenes.size());
  int done = 0;
  workers.run(
      static_cast<int>(scenes.size()), [&](int i, int) { return text_of(scenes[static_cast<std::size_t>(i)], job); },
      [&](const render::TaskResult& result) {
        const auto scene = static_cast<std::size_t>(result.task);
        out[scene] = collect(scenes[scene], job, result);
        progress(++done);
      });
  return out;
}

}  // namespace cli
