#include "cli/snapshot/check.h"

#include <fmt/format.h>
#include <fnmatch.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <thread>

#include "cli/exit.h"
#include "cli/film_plan.h"
#include "cli/progress.h"
#include "cli/snapshot/baselines.h"
#include "cli/snapshot/judge.h"
#include "engine/measure/metrics.h"
#include "engine/simulate.h"
#include "render/painter.h"

namespace cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

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

struct FileCloser {
  void operator()(std::FILE* f) const { std::fclose(f); }
};
using FilePtr = std::unique_ptr<std::FILE, FileCloser>;

/// A scene at work in its process, which writes its report into a file without a name that both have open.
struct Running {
  std::size_t scene = 0;
  FilePtr report;
};

[[noreturn]] void work(const fs::path& scene, const CheckJob& job, std::FILE* report, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kMachineFailed);  // the parent died before the line above could bind us to it
  const std::string text = check_scene(scene, job).dump(-1, ' ', false, Json::error_handler_t::replace);
  const bool written = std::fwrite(text.data(), 1, text.size(), report) == text.size() && std::fflush(report) == 0;
  _exit(written ? kDone : kMachineFailed);
}

Json collect(const fs::path& scene, const CheckJob& job, std::FILE* file, int status) {
  std::string text;
  std::rewind(file);
  char block[4096];
  for (std::size_t n = 0; (n = std::fread(block, 1, sizeof block, file)) > 0;) text.append(block, n);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kDone) return Json::parse(text);
  const std::string end = WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : fmt::format("exit code {}", WEXITSTATUS(status));
  return {{"scene", scene.lexically_proximate(job.root).string()},
          {"title", ""},
          {"names", Json::array()},
          {"errors", {fmt::format("the process that checked it ended: {}", end)}},
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
  const std::size_t workers = static_cast<std::size_t>(job.workers > 0 ? job.workers : cores);
  std::vector<SceneReport> out(scenes.size());
  std::map<pid_t, Running> running;
  std::size_t next = 0;
  int done = 0;
  const pid_t parent = getpid();
  while (next < scenes.size() || !running.empty()) {
    while (next < scenes.size() && running.size() < workers) {
      FilePtr report(std::tmpfile());
      if (!report) throw MachineError(fmt::format("opening a temporary file: {}", std::strerror(errno)));
      std::fflush(nullptr);
      const pid_t pid = fork();
      if (pid < 0) throw MachineError(fmt::format("starting a process: {}", std::strerror(errno)));
      if (pid == 0) work(scenes[next], job, report.get(), parent);
      running[pid] = {next++, std::move(report)};
    }
    int status = 0;
    const pid_t ended = waitpid(-1, &status, 0);
    if (ended < 0 && errno == EINTR) continue;
    if (ended < 0) throw MachineError(fmt::format("waiting for a process: {}", std::strerror(errno)));
    const auto at = running.find(ended);
    if (at == running.end()) continue;
    const std::size_t scene = at->second.scene;
    out[scene] = collect(scenes[scene], job, at->second.report.get(), status);
    running.erase(at);
    progress(++done);
  }
  return out;
}

}  // namespace cli
