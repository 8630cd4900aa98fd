// Runs odd scenes by the thousand: odd_scenes --scenes N [--seed N] [--draw-every N] [--jobs N] [--only SEED]
// Each is loaded, simulated for 50 ms, measured, laid out as a film, and every so often drawn, with its figures. Nothing may end
// the process, hang, or hold a number that is not finite. A divergence that the engine names is an answer, not an error; it is
// counted.
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "engine/address_sanitizer.h"
#include "engine/measure/metrics.h"
#include "engine/simulate.h"
#include "render/cameras.h"
#include "render/error.h"
#include "render/figures/figures.h"
#include "render/painter.h"
#include "render/video/story.h"
#include "scenes/loader/builder.h"
#include "tests/odd_scenes/generator.h"

namespace fs = std::filesystem;

namespace {

constexpr double kDuration = 0.05;      // [s] simulated
constexpr double kPatience = 120;       // [s] of the processor, for one scene: how busy the machine is does not count
constexpr double kLongPatience = 1200;  // [s] of the clock, for one that waits for something
constexpr rlim_t kMemory = 3ull << 30;  // [byte]

enum Outcome { ran, diverged, not_finite, threw, died, hung, kOutcomes };
constexpr const char* kNames[] = {"ran", "diverged and said so", "not finite", "threw", "died", "hung"};

/// One process that takes every n-th seed; its parent sees where it is.
struct Worker {
  std::atomic<std::uint64_t> seed{0};
  std::atomic<double> started{0}, started_clock{0};  // [s] of its processor time, of the clock
  std::atomic<long> outcomes[kOutcomes] = {}, oddities{0}, drawn{0};
  std::atomic<std::uint64_t> slowest{0};
  std::atomic<double> slowest_took{0};  // [s] of the processor
  pid_t pid = -1;
};

struct Wish {
  std::uint64_t scenes = 1000, seed = 1;
  int draw_every = 0, jobs = 1;
  bool only = false;
};

double seconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// What a process has used; nothing once it is gone.
double used_by(pid_t pid) {
  clockid_t clock{};
  return clock_getcpuclockid(pid, &clock) == 0 ? seconds(clock) : 0;
}

std::vector<odd::Generator::Base> bases() {
  const fs::path root = scenes::home_folder();
  std::vector<odd::Generator::Base> out;
  for (const auto& entry : fs::directory_iterator(root / "tests/odd_scenes/bases"))
    // persons under the compliant law take a hundred times as long
    if (entry.path().extension() == ".toml") out.push_back({entry.path(), entry.path().stem() == "compliant_person" ? 0.02 : 8});
  for (const auto& entry : fs::directory_iterator(root / "scenes/gallery")) {
    const std::string name = entry.path().stem().string();
    // the figure's skin takes half a second to make
    const bool dressed = name.starts_with("pose_") || name == "overlays" || name.starts_with("appearance_");
    if (entry.path().extension() == ".toml") out.push_back({entry.path(), dressed ? 0.02 : 1});
  }
  for (const auto& entry : fs::directory_iterator(root / "scenes/cases"))
    if (entry.path().extension() == ".toml") out.push_back({entry.path(), 0.02});
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.file < b.file; });
  return out;
}

bool finite(const engine::Recording& recording) {
  bool good = true;
  const auto number = [&good](double x) { good = good && std::isfinite(x); };
  const auto vector = [&good](const auto& v) { good = good && v.allFinite(); };
  for (const engine::Snapshot& s : recording.snapshots) {
    for (const engine::BodyState& b : s.bodies) {
      vector(b.X_WB.p);
      vector(b.X_WB.q.coeffs());
      vector(b.V_WB.v);
      vector(b.V_WB.w);
    }
    for (const engine::ContactRecord& c : s.contacts) {
      for (const auto& v : {c.point, c.normal, c.force, c.impulse}) vector(v);
      for (const double x : {c.depth, c.normal_force, c.tangential_force, c.normal_impulse, c.tangential_impulse, c.slip})
        number(x);
    }
    for (const engine::WheelRecord& w : s.wheels) {
      vector(w.hub);
      for (const double x : {w.steer, w.spin, w.load, w.longitudinal, w.lateral, w.slip}) number(x);
    }
    for (const double x : {s.energies.kinetic, s.energies.potential, s.energies.added, s.energies.residual}) number(x);
    for (const double x : s.energies.dissipated) number(x);
  }
  for (const engine::Event& e : recording.events) {
    number(e.time);
    number(e.value);
    vector(e.point);
  }
  const engine::Diagnostics& d = recording.diagnostics;
  for (const double x : {d.max_joint_gap, d.max_joint_angle_error, d.max_penetration, d.max_solver_residual, d.max_energy_rise})
    number(x);
  return good;
}

/// Looks at some frames of each shot, its first and last among them.
bool finite_film(const scenes::Scene& scene, const engine::Recording& recording, const render::Film& film) {
  constexpr int kLooks = 100;
  std::vector<int> looked_at;
  for (const auto [first, last] : film.shots()) {
    for (int i = first; i < last; i += 1 + (last - first) / kLooks) looked_at.push_back(i);
    looked_at.push_back(last);
  }
  for (const int i : looked_at) {
    const render::Moment moment = film[i];
    if (!std::isfinite(moment.time)) return false;
    for (const render::Camera& camera : scene.stage.cameras) {
      if (camera.name != moment.camera) continue;
      const render::View view = render::view_of(camera, recording, moment.time, 16.0 / 9);
      for (const auto* matrix : {&view.world_to_eye, &view.eye_to_clip})
        for (const float x : *matrix)
          if (!std::isfinite(x)) return false;
    }
  }
  return true;
}

void draw(const scenes::Scene& scene, const engine::Recording& recording, const render::Film& film) {
  render::Painter painter(64, 48, render::Quality::draft);
  render::Image image;
  for (int i = 0; i < film.size(); i += std::max(1, film.size() / 4)) painter.paint(scene.stage, recording, film[i], image);
  const fs::path folder = fs::temp_directory_path() / ("crashreel_odd_" + std::to_string(getpid()));
  fs::create_directory(folder);
  render::FigureJob job;
  job.folder = folder;
  job.width = 320;
  job.height = 240;
  job.quality = render::Quality::draft;
  for (const auto figure :
       {render::site_diagram, render::contact_map, render::time_histories, render::stroboscopic_still, render::contact_sheet})
    figure(scene.stage, recording, job);
  fs::remove_all(folder);
}

Outcome run(const odd::OddScene& odd, bool drawn) {
  const scenes::Scene& scene = odd.scene;
  const engine::Recording recording = engine::simulate(scene.model);
  const auto found = [](const char* what) {
    std::printf("not finite: %s\n", what);
    return not_finite;
  };
  if (!finite(recording)) return found("recording");
  for (const engine::Metric& metric : engine::measure(scene.model, recording))
    if (!std::isfinite(metric.value)) return found(metric.key.c_str());
  try {
    const render::Film film(scene.stage, recording.end_time(), scene.output.fps);
    render::story_of(scene.stage, recording, film, scene.output.fps);
    if (!finite_film(scene, recording, film)) return found("film");
    if (drawn) draw(scene, recording, film);
  } catch (const render::FilmTooLong&) {
    // slow motion beyond measure, refused by the name of its shot
  }
  return recording.failure ? diverged : ran;
}

void tell(const odd::OddScene& odd) {
  std::printf("  crashreel simulate %s -o out", odd.base.c_str());
  for (const std::string& text : odd.overrides) std::printf(" --set \"%s\"", text.c_str());
  std::printf("\n");
}

/// Seeds first, first + jobs ... each to its outcome.
[[noreturn]] void work(const Wish& wish, const odd::Generator& generator, Worker& me, std::uint64_t first) {
  if (!engine::kAddressSanitizer) {
    const rlimit limit{kMemory, kMemory};
    setrlimit(RLIMIT_AS, &limit);
  }
  for (std::uint64_t seed = first; seed < wish.seed + wish.scenes; seed += static_cast<std::uint64_t>(wish.jobs)) {
    me.seed = seed;
    me.started = seconds(CLOCK_PROCESS_CPUTIME_ID);
    me.started_clock = seconds(CLOCK_MONOTONIC);
    const bool drawn = wish.draw_every > 0 && seed % static_cast<std::uint64_t>(wish.draw_every) == 0;
    try {
      const odd::OddScene odd = generator.make(seed, kDuration);
      const Outcome outcome = run(odd, drawn);
      ++me.outcomes[outcome];
      me.oddities += static_cast<long>(odd.overrides.size()) - 1;
      me.drawn += drawn;
      if (outcome == not_finite) std::printf("seed %lu: not finite\n", seed);
    } catch (const std::exception& error) {
      ++me.outcomes[threw];
      std::printf("seed %lu: %s\n", seed, error.what());
    }
    if (const double took = seconds(CLOCK_PROCESS_CPUTIME_ID) - me.started; took > me.slowest_took) {
      me.slowest_took = took;
      me.slowest = seed;
    }
    std::fflush(stdout);
  }
  _exit(0);
}

void start(const Wish& wish, const odd::Generator& generator, Worker& worker, std::uint64_t first) {
  worker.started = 0;
  worker.started_clock = seconds(CLOCK_MONOTONIC);
  worker.seed = first;
  const pid_t pid = fork();
  if (pid == 0) work(wish, generator, worker, first);
  worker.pid = pid;
}

/// Lets them work; one that died or hangs is told and replaced at its next seed.
void oversee(const Wish& wish, const odd::Generator& generator, Worker* workers) {
  for (int left = wish.jobs; left > 0; std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
    for (int w = 0; w < wish.jobs; ++w) {
      Worker& worker = workers[w];
      if (worker.pid < 0) continue;
      int status = 0;
      const bool ended = waitpid(worker.pid, &status, WNOHANG) == worker.pid;
      const bool hangs = !ended && (used_by(worker.pid) > worker.started + kPatience ||
                                    seconds(CLOCK_MONOTONIC) > worker.started_clock + kLongPatience);
      if (hangs) {
        kill(worker.pid, SIGKILL);
        waitpid(worker.pid, &status, 0);
      }
      if (!ended && !hangs) continue;
      worker.pid = -1;
      if (ended && WIFEXITED(status) && WEXITSTATUS(status) == 0) {
        --left;
        continue;
      }
      ++worker.outcomes[hangs ? hung : died];
      std::printf("seed %lu: %s\n", worker.seed.load(), hangs ? "hung" : strsignal(WTERMSIG(status)));
      std::fflush(stdout);
      start(wish, generator, worker, worker.seed + static_cast<std::uint64_t>(wish.jobs));
    }
  }
}

Wish read_wish(int argc, char** argv) {
  Wish wish;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    const auto n = std::strtoull(argv[i + 1], nullptr, 10);
    if (name == "--scenes") wish.scenes = n;
    if (name == "--seed" || name == "--only") wish.seed = n;
    if (name == "--draw-every") wish.draw_every = static_cast<int>(n);
    if (name == "--jobs") wish.jobs = static_cast<int>(n);
    wish.only = wish.only || name == "--only";
  }
  return wish;
}

}  // namespace

int main(int argc, char** argv) {
  const Wish wish = read_wish(argc, argv);
  setenv("LP_NUM_THREADS", "0", 1);
  const odd::Generator generator(bases());
  if (wish.only) {
    const odd::OddScene odd = generator.make(wish.seed, kDuration);
    tell(odd);
    std::fflush(stdout);
    const Outcome outcome = run(odd, wish.draw_every > 0);
    std::printf("  %s\n", kNames[outcome]);
    return outcome == ran || outcome == diverged ? 0 : 1;
  }
  void* shared = mmap(nullptr, sizeof(Worker) * static_cast<std::size_t>(wish.jobs), PROT_READ | PROT_WRITE,
                      MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto* workers = static_cast<Worker*>(shared);
  for (int w = 0; w < wish.jobs; ++w) start(wish, generator, *new (workers + w) Worker, wish.seed + static_cast<std::uint64_t>(w));
  oversee(wish, generator, workers);

  long sums[kOutcomes] = {}, oddities = 0, drawn = 0;
  for (int w = 0; w < wish.jobs; ++w) {
    for (int o = 0; o < kOutcomes; ++o) sums[o] += workers[w].outcomes[o];
    oddities += workers[w].oddities;
    drawn += workers[w].drawn;
  }
  std::printf("%lu odd scenes, %.1f oddities each, %ld drawn:", wish.scenes,
              static_cast<double>(oddities) / static_cast<double>(wish.scenes), drawn);
  const Worker& slow = *std::max_element(
      workers, workers + wish.jobs, [](const Worker& a, const Worker& b) { return a.slowest_took.load() < b.slowest_took.load(); });
  for (int o = 0; o < kOutcomes; ++o) std::printf(" %ld %s%s", sums[o], kNames[o], o + 1 < kOutcomes ? "," : "\n");
  std::printf("slowest: seed %lu, %.1f s of the processor\n", slow.slowest.load(), slow.slowest_took.load());
  return sums[not_finite] + sums[threw] + sums[died] + sums[hung] == 0 ? 0 : 1;
}
