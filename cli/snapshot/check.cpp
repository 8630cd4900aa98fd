#include "cli/snapshot/check.h"

#include <fmt/format.h>
#include <fnmatch.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <thread>

#include "cli/exit.h"
#include "cli/film_plan.h"
#include "cli/output/difference.h"
#include "cli/progress.h"
#include "cli/snapshot/baselines.h"
#include "engine/measure/metrics.h"
#include "engine/simulate.h"
#include "render/arrange.h"
#include "render/error.h"
#include "render/image/compare.h"
#include "render/image/png.h"
#include "render/renderer.h"

namespace cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

render::Limits limits_of(const scenes::Scene& scene) {
  render::Limits limits;
  for (const auto& [name, value] : scene.snapshot.limits) set_limit(limits, name, value);
  return limits;
}

std::vector<render::Mask> masks_of(const scenes::Scene& scene, const std::string& camera) {
  std::vector<render::Mask> out;
  for (const scenes::SnapshotMask& mask : scene.snapshot.masks)
    if (mask.camera.empty() || mask.camera == camera) out.push_back({mask.left, mask.top, mask.width, mask.height});
  return out;
}

/// "rms is 0.5 (limit 0.3), ssim is 0.9 (limit 0.995)"
std::string reasons(const render::Difference& found, const render::Limits& limits) {
  std::string out;
  for (const render::Measure* measure : render::beyond(found, limits)) {
    out += fmt::format("{}{} is {:.4g} (limit {:g})", out.empty() ? "" : ", ", measure->name, found.*measure->value,
                       limits.*measure->limit);
  }
  return out;
}

/// The report's pictures of one still; `stem` makes their names unique among all scenes.
void keep_pictures(const CheckJob& job, const std::string& stem, const render::Image& actual, const render::Image* expected,
                   const std::vector<render::Mask>& masks, Json& out) {
  const auto write = [&](const char* kind, const render::Image& image) {
    const std::string file = fmt::format("{}_{}.png", stem, kind);
    render::write_png(job.pictures / file, image, {}, render::PngEffort::small);
    out[kind] = (job.pictures.filename() / file).string();
  };
  write("actual", actual);
  if (!expected) return;
  write("expected", *expected);
  if (expected->width != actual.width || expected->height != actual.height) {
    const render::Image both[] = {*expected, actual};
    write("side_by_side", render::side_by_side(both));
    return;
  }
  const render::Image difference = render::difference_picture(*expected, actual, masks);
  write("difference", difference);
  const render::Image all[] = {*expected, actual, difference};
  write("side_by_side", render::side_by_side(all));
}

/// Compares what was drawn with the baseline, if that can be read and has its size.
Json judge(const scenes::Scene& scene, const Still& still, const render::Image& actual, const std::string& stem,
           const CheckJob& job) {
  Json out = {{"name", still.name}, {"baseline", still.baseline.string()}, {"camera", still.camera}, {"time_s", still.time}};
  const auto say = [&out](const char* verdict, const std::string& why) {
    out["verdict"] = verdict;
    out["why"] = why;
  };
  const std::vector<render::Mask> masks = masks_of(scene, still.camera);
  if (!fs::exists(still.baseline)) {
    if (listed(baseline_folder(scene.path)).contains(still.name)) {
      say("missing", "its baseline was accepted once and is gone");
    } else {
      say("new", "it has no baseline yet");
    }
    keep_pictures(job, stem, actual, nullptr, masks, out);
    return out;
  }
  render::Image expected;
  try {
    expected = render::read_png(still.baseline);
  } catch (const render::RenderError& error) {
    say("unreadable", error.what());
    keep_pictures(job, stem, actual, nullptr, masks, out);
    return out;
  }
  if (expected.width != actual.width || expected.height != actual.height) {
    say("different",
        fmt::format("the baseline is {}x{}, the picture {}x{}", expected.width, expected.height, actual.width, actual.height));
    keep_pictures(job, stem, actual, &expected, masks, out);
    return out;
  }
  const render::Limits limits = limits_of(scene);
  const render::Difference found = render::difference_of(expected, actual, masks);
  const bool same = render::within(found, limits);
  say(same ? "same" : "different", reasons(found, limits));
  out["figures"] = difference_json(found);
  out["limits"] = limits_json(limits);
  // someone who updates by name may want the bits of today even where they are within the limits
  if (!same || (!job.only.empty() && found.differing > 0)) keep_pictures(job, stem, actual, &expected, masks, out);
  return out;
}

Json judge_measure(const scenes::Expectation& expected, const std::vector<engine::Metric>& metrics) {
  Json out = {{"metric", expected.metric + (expected.object.empty() ? "" : " " + expected.object)}, {"expected", expected.written}};
  std::vector<const engine::Metric*> found;
  std::vector<std::string> known;
  for (const engine::Metric& metric : metrics) {
    known.push_back(metric.key + (metric.object.empty() ? "" : " " + metric.object));
    if (metric.key == expected.metric && (expected.object.empty() || expected.object == metric.object)) found.push_back(&metric);
  }
  if (found.size() != 1) {
    out["verdict"] = "missing";
    out["why"] =
        fmt::format("{}; the run has {}", found.empty() ? "the run has no such measure" : "several objects have it, name one",
                    known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", ")));
    return out;
  }
  const double value = found.front()->value, off = value - expected.value;
  // the tolerance as written: a value on its edge is within, whatever the last bit of the difference
  const bool same = std::abs(off) <= expected.tolerance * (1 + 1e-12);
  out["found"] = value;
  out["verdict"] = same ? "same" : "different";
  out["why"] = same ? "" : fmt::format("is {:.6g}, expected {}, off by {:+.3g}", value, expected.written, off);
  return out;
}

/// Everything about one scene. What it cannot do stands in its errors.
Json check_scene(const fs::path& file, const CheckJob& job) {
  const double start = clock_seconds();
  const fs::path relative = file.lexically_proximate(job.root);
  Json out = {{"scene", relative.string()}, {"title", ""},
              {"names", Json::array()},     {"errors", Json::array()},
              {"pictures", Json::array()},  {"measures", Json::array()}};
  try {
    scenes::Scene scene = scenes::load(file);
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
    if (!stills.empty()) {
      const int width = scene.snapshot.width, height = scene.snapshot.height;
      render::Renderer renderer(width, height, quality_of(scene.output.quality));
      render::Image image;
      for (const Still& still : stills) {
        renderer.draw(render::arrange(scene.stage, run, {still.time, still.camera, 1}, static_cast<double>(width) / height), image);
        std::string stem = (relative.parent_path() / still.name).string();
        std::replace(stem.begin(), stem.end(), '/', '_');
        out["pictures"].push_back(judge(scene, still, image, stem, job));
      }
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
  setenv("LP_NUM_THREADS", "0", 1);                // one process a core: threads inside would only wait for each other
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
  return std::any_of(patterns.begin(), patterns.end(), [&name](const std::string& pattern) {
    return fnmatch(pattern.c_str(), name.c_str(), 0) == 0 || fnmatch(pattern.c_str(), (name + ".png").c_str(), 0) == 0;
  });
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
