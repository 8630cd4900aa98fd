#include "cli/estimate.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <cstdlib>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/exit.h"
#include "cli/process.h"
#include "cli/progress.h"
#include "engine/address_sanitizer.h"
#include "engine/simulate.h"

namespace cli {
namespace {

constexpr double kEnoughToLoad = engine::kAddressSanitizer ? 1e14 : 200e6;  // [byte] for any scene of the library

namespace fs = std::filesystem;

constexpr double kProbe = 2;      // [s] of the clock spent on simulating
constexpr int kProbeFrames = 3;   // the first pays for starting, the others tell the pace
constexpr double kRow = 190;      // [byte] of a row of trajectory.csv or contacts.csv
constexpr double kH264 = 0.015;   // [-] of the PNGs' size, measured on the shipped cases at crf 20: 0.008 to 0.01
constexpr double kFfv1 = 0.75;    // [-] of the PNGs' size, likewise 0.54 to 0.7
constexpr double kProgram = 6e7;  // [byte] the program with its libraries

struct Probe {
  engine::Recording recording;
  double wall = 0;     // [s]
  double stretch = 1;  // of the part simulated to the whole
};

Probe simulate_a_little(const scenes::Scene& scene, const engine::Plan& plan) {
  Probe probe;
  const double start = clock_seconds();
  bool whole = true;
  engine::RunOptions options;
  options.progress = [&](double) {
    check_interrupted();
    return whole = clock_seconds() - start < kProbe;
  };
  probe.recording = engine::simulate(scene.model, plan, options);
  probe.wall = clock_seconds() - start;
  const double reached = static_cast<double>(probe.recording.steps) * scene.model.settings.step;
  if (!whole && reached > 0) probe.stretch = std::max(1.0, scene.model.settings.duration / reached);
  return probe;
}

Estimate of_results(const scenes::Scene& scene, const Probe& probe) {
  const engine::Recording& r = probe.recording;
  Estimate out;
  out.simulated = probe.stretch == 1;
  out.steps = out.simulated ? r.steps : std::lround(scene.model.settings.duration / scene.model.settings.step);
  out.seconds = probe.wall * probe.stretch;
  double kept = 0, rows = 0;
  for (const engine::Snapshot& s : r.snapshots) {
    kept += static_cast<double>(
        sizeof s + s.bodies.size() * sizeof(engine::BodyState) + s.contacts.capacity() * sizeof(engine::ContactRecord) +
        s.wheels.capacity() * sizeof(engine::WheelRecord) + s.energies.dissipated.capacity() * sizeof(double));
    rows += static_cast<double>(s.bodies.size() + s.contacts.size());
  }
  for (const engine::HeadMotion& head : r.heads) kept += 2 * static_cast<double>(head.time.capacity() * sizeof(double));
  // a growing vector holds its old self and a new one of twice the size for a moment
  out.recording = kProgram + 2 * kept * probe.stretch;
  out.disk = (kRow * rows + kept) * probe.stretch;  // recording.bin has what memory has
  return out;
}

/// The frames asked for, as far as is known.
render::Film frames_known(const scenes::Scene& scene, const Probe& probe, const FilmPlan& plan, int& count) {
  const double known = probe.recording.end_time();
  if (plan.stills.empty()) {
    count = frames_of(plan, scene.stage, probe.stretch == 1 ? known : scene.model.settings.duration).size();
    return frames_of(plan, scene.stage, known);
  }
  std::vector<render::Moment> moments;
  for (const double time : plan.stills) moments.push_back(still_of(plan, scene.stage, time));
  count = static_cast<int>(moments.size());
  return render::Film(moments);
}

/// Draws some of the frames; what that takes of a process, of the clock and of the disk.
void draw_a_little(const scenes::Scene& scene, const Probe& probe, const FilmPlan& plan, const render::Film& film, Estimate& out) {
  if (film.empty() || out.frames == 0) return;
  const int apart = std::max(1, film.size() / kProbeFrames);
  std::vector<render::Moment> some;
  for (int i = 0; i < film.size() && some.size() < kProbeFrames; i += apart) some.push_back(film[i]);
  std::string pattern = (fs::temp_directory_path() / "crashreel_estimate_XXXXXX").string();
  if (!mkdtemp(pattern.data())) throw MachineError("making a folder in " + fs::temp_directory_path().string());
  const struct Remover {
    fs::path folder;
    ~Remover() {
      std::error_code ignored;
      fs::remove_all(folder, ignored);
    }
  } temporary{pattern};
  render::FilmJob job = plan.job;
  job.output = temporary.folder / "frame_%05d.png";
  job.container = render::Container::png_sequence;
  job.workers = 1;
  const double start = clock_seconds();
  double first = 0;
  render::make_film(scene.stage, probe.recording, render::Film(some), job, [&](const render::FilmProgress& now) {
    if (now.frames_done == 1) first = clock_seconds() - start;
  });
  const double all = clock_seconds() - start;
  const auto drawn = static_cast<double>(some.size());
  const double pace = some.size() > 1 ? (all - first) / (drawn - 1) : all;
  double bytes = 0;
  for (const fs::directory_entry& file : fs::directory_iterator(temporary.folder)) bytes += static_cast<double>(file.file_size());
  rusage children{};
  getrusage(RUSAGE_CHILDREN, &children);
  out.worker = 1024.0 * static_cast<double>(children.ru_maxrss);
  const double pixels = static_cast<double>(job.width) * job.height;
  // twice as many slots as processes: render/film.cpp
  out.shared = plan.job.container == render::Container::mp4 ? 2 * 1.5 * pixels
               : render::is_video(plan.job.container)       ? 2 * 4 * pixels
                                                            : 0;
  out.seconds += first + pace * (out.frames - 1.0) / out.workers;
  const double share = plan.job.container == render::Container::mp4 ? kH264 : render::is_video(plan.job.container) ? kFfv1 : 1;
  out.disk = bytes / drawn * out.frames * share;
}

}  // namespace

Estimate estimate_results(const scenes::Scene& scene, const engine::Plan& plan) {
  return of_results(scene, simulate_a_little(scene, plan));
}

Estimate estimate_film(const scenes::Scene& scene, const engine::Plan& plan, const FilmPlan& film) {
  const Probe probe = simulate_a_little(scene, plan);
  Estimate out = of_results(scene, probe);
  out.disk = 0;
  const render::Film known = frames_known(scene, probe, film, out.frames);
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  out.workers = std::clamp(film.job.workers > 0 ? film.job.workers : cores, 1, std::max(1, out.frames));
  draw_a_little(scene, probe, film, known, out);
  return out;
}

std::string estimate_text(const Estimate& e, double step) {
  const std::string processes =
      e.workers > 0 ? fmt::format(" with {} drawing process{}", e.workers, e.workers == 1 ? "" : "es") : "";
  return fmt::format("{}{} steps of {} s, about {} of memory{}, {} on the disk, {}", e.simulated ? "" : "at most ", e.steps, step,
                     bytes_text(e.memory()), processes, bytes_text(e.disk), readable_time(e.seconds));
}

nlohmann::ordered_json estimate_json(const Estimate& e) {
  return {{"steps", e.steps},
          {"simulated", e.simulated},
          {"memory_bytes", std::llround(e.memory())},
          {"disk_bytes", std::llround(e.disk)},
          {"seconds", e.seconds},
          {"workers", e.workers}};
}

std::string bytes_text(double bytes) {
  constexpr const char* kUnits[] = {"kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  double value = bytes / 1e3;
  for (; value >= 999.5 && unit + 1 < std::size(kUnits); ++unit) value /= 1e3;
  return fmt::format("{:.3g} {}", value, kUnits[unit]);
}

double parse_bytes(const std::string& option, const std::string& text) {
  constexpr std::pair<std::string_view, double> kUnits[] = {{"kB", 1e3},   {"MB", 1e6},      {"GB", 1e9},
                                                            {"TB", 1e12},  {"M", 1e6},       {"G", 1e9},
                                                            {"KiB", 1024}, {"MiB", 1048576}, {"GiB", 1073741824.0}};
  double number = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  std::string unit(end, text.data() + text.size());
  std::erase(unit, ' ');
  const auto* known = std::find_if(std::begin(kUnits), std::end(kUnits), [&unit](const auto& u) { return unit == u.first; });
  const double bytes = known == std::end(kUnits) ? 0 : number * known->second;
  if (problem != std::errc() || !(bytes >= 1e6) || !(bytes <= 1e15))
    throw UsageError(fmt::format("{} is \"{}\": must be an amount of memory from 1 MB on, like \"2 GB\"", option, text));
  return bytes;
}

LoadingLimit::LoadingLimit(double ceiling) {
  if (ceiling <= 0 || getrlimit(RLIMIT_DATA, &before_) != 0) return;
  rlimit limit = before_;
  limit.rlim_cur = std::min(limit.rlim_max, static_cast<rlim_t>(std::max(ceiling, kEnoughToLoad)));
  held_ = setrlimit(RLIMIT_DATA, &limit) == 0;
}

LoadingLimit::~LoadingLimit() {
  if (held_) setrlimit(RLIMIT_DATA, &before_);
}

void limit_memory(double bytes) {
  const rlimit limit{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
  if (setrlimit(RLIMIT_DATA, &limit) != 0) throw MachineError("the system sets no limit for --max-memory");
}

void hold_to_memory(const Estimate& estimate, double ceiling, int& workers, bool quiet) {
  const double one = estimate.worker + estimate.shared;
  const int fitting = one > 0 ? static_cast<int>(std::clamp((ceiling - estimate.recording) / one, 0.0, 1e6)) : 1;
  if (fitting < 1 || estimate.recording > ceiling) {
    throw UsageError(
        fmt::format("the job needs about {}{}, --max-memory is {}; a smaller --size, a longer record_interval or a "
                    "shorter duration need less",
                    bytes_text(estimate.recording + one), one > 0 ? " with one drawing process" : "", bytes_text(ceiling)));
  }
  if (one > 0 && fitting < estimate.workers) {
    if (!quiet)
      fmt::print(stderr, "crashreel: {} drawing process{} in place of {}, to stay below --max-memory {}\n", fitting,
                 fitting == 1 ? "" : "es", estimate.workers, bytes_text(ceiling));
    workers = fitting;
  }
  limit_memory(ceiling);
}

}  // namespace cli
