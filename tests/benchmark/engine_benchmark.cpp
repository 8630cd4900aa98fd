// What the engine does in a second, and how well: `build/tests/benchmark_engine [part...] [--peer name=program]...`
// Parts: scenes, whole, throughput, ensemble, persons, triangles, plan, waiting, dense, lockstep. Times are medians on one core;
// ratios compare runs of the same call. A peer is a program that takes `scene=NAME dt=SECONDS reps=N pert=MICROMETRES damp=NMS` and
// prints comma separated values with steps/s in column six and where the figure ends in column twenty.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "engine/plan.h"
#include "engine/simulate.h"
#include "scenes/loader/builder.h"
#include "scenes/scene.h"
#include "tests/benchmark/common_scenes.h"
#include "tests/benchmark/dense_algebra.h"
#include "tests/benchmark/lockstep.h"
#include "tests/benchmark/whole_runs.h"

namespace {

using engine::Model;
using engine::Recording;

struct Peer {
  std::string name, program;
};

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Timed {
  Recording run;
  double wall_s = 0;  // median
  double steps_per_s() const { return static_cast<double>(run.steps) / wall_s; }
};

Timed timed(const Model& model, int repetitions) {
  Timed out;
  std::vector<double> walls;
  for (int r = 0; r < repetitions; ++r) {
    const double start = now();
    out.run = engine::simulate(model);
    walls.push_back(now() - start);
  }
  out.wall_s = median(walls);
  return out;
}

Model pedestrian_case() {
  return scenes::load(scenes::home_folder() / "scenes/cases/sedan_pedestrian_40kmh.toml").model;
}

engine::Vec3 centre_of_figure(const Model& model, const Recording& run) {
  engine::Vec3 sum = engine::Vec3::Zero();
  double mass = 0;
  for (const int b : model.persons.front().bodies) {
    sum += model.bodies[b].mass * run.snapshots.back().bodies[b].X_WB.p;
    mass += model.bodies[b].mass;
  }
  return sum / mass;
}

/// The value in such a column (from 1) of what a peer prints; 0 if there is none.
double peer_value(const Peer& peer, const std::string& arguments, int column) {
  FILE* pipe = popen((peer.program + " " + arguments).c_str(), "r");
  if (!pipe) return 0;
  char line[1024] = {};
  const bool any = std::fgets(line, sizeof line, pipe) != nullptr;
  pclose(pipe);
  if (!any) return 0;
  std::string text = line;
  for (int passed = 1; passed < column; ++passed) {
    const auto comma = text.find(',');
    if (comma == std::string::npos) return 0;
    text.erase(0, comma + 1);
  }
  return std::strtod(text.c_str(), nullptr);
}

/// The rate over each peer's in rounds that run one after the other, for a busy host gives less to one minute than to the next.
struct Rates {
  Timed ours;
  std::vector<double> over_peers;  // medians of the rounds
};

Rates rates(const Model& model, const std::string& scene, const std::vector<Peer>& peers) {
  constexpr int kRounds = 9;
  Rates out;
  std::vector<double> walls;
  std::vector<std::vector<double>> over(peers.size());
  for (int round = 0; round < kRounds; ++round) {
    const Timed once = timed(model, 1);
    walls.push_back(once.wall_s);
    for (std::size_t p = 0; p < peers.size(); ++p)
      over[p].push_back(once.steps_per_s() / peer_value(peers[p], "scene=" + scene + " dt=0.001 reps=1", 6));
    out.ours.run = once.run;
  }
  out.ours.wall_s = median(walls);
  for (const std::vector<double>& of_peer : over) out.over_peers.push_back(median(of_peer));
  return out;
}

/// Rates of starts tilted by 0 to 22 mrad [steps/s]: how often contacts jam hangs on last digits, and one start is one of many.
std::vector<double> tilted_rates(const std::string& scene) {
  constexpr int kStarts = 12;
  std::vector<double> rates;
  for (int k = 0; k < kStarts; ++k) {
    Model model = benchmark::common_scene(scene, 1e-3);
    benchmark::tilt(model, 2e-3 * k);
    rates.push_back(timed(model, 3).steps_per_s());
  }
  return rates;
}

void common_scenes(const std::vector<Peer>& peers) {
  std::printf(
      "Common scenes, step 1 ms, one core; `tilted`: median and slowest of twelve starts\n%-8s %9s %9s %9s %9s %10s %10s %9s %8s "
      "%8s",
      "scene", "steps/s", "tilted", "slowest", "drift m", "limit deg", "penetr. mm", "residual", "sweeps", "x end m");
  for (const Peer& peer : peers) std::printf(" %14s", ("x " + peer.name).c_str());
  std::printf("\n");
  for (const std::string scene : {"flight", "drop", "throw", "vehicle"}) {
    const Model model = benchmark::common_scene(scene, 1e-3);
    const auto [t, over_peers] = rates(model, scene, peers);
    const auto& d = t.run.diagnostics;
    const std::vector<double> tilted = tilted_rates(scene);
    std::printf("%-8s %9.0f %9.0f %9.0f %9.1e %10.4f %10.4f %9.1e %8.2f %8.3f", scene.c_str(), t.steps_per_s(), median(tilted),
                *std::min_element(tilted.begin(), tilted.end()), d.max_joint_gap, d.max_joint_angle_error * 180 / std::numbers::pi,
                d.max_penetration * 1e3, d.max_solver_residual,
                static_cast<double>(d.contact_sweeps) / static_cast<double>(t.run.steps), centre_of_figure(model, t.run).x());
    for (const double ratio : over_peers)
      std::printf(" %14s", std::isfinite(ratio) ? fmt::format("{:.2f}", ratio).c_str() : "no such scene");
    std::printf("\n");
    std::fflush(stdout);
  }
  const Model coarse = benchmark::common_scene("flight", 1e-3), fine = benchmark::common_scene("flight", 1.0 / 16e3);
  const Recording a = engine::simulate(coarse), b = engine::simulate(fine);
  double error = 0;
  for (std::size_t i = 0; i < coarse.bodies.size(); ++i)
    error = std::max(error, (a.snapshots.back().bodies[i].X_WB.p - b.snapshots.back().bodies[i].X_WB.p).norm());
  std::printf("flight: error after 1 s at 1 ms %.2e m\n\n", error);
}

constexpr double kDampingOfComparison = 0.1;  // [N m s/rad]

struct Spread {
  double mean, deviation;  // [m]
};

Spread spread_of(const std::vector<double>& values) {
  double sum = 0, squares = 0;
  for (const double x : values) sum += x, squares += x * x;
  const double mean = sum / static_cast<double>(values.size());
  return {mean, std::sqrt(std::max(0.0, squares / static_cast<double>(values.size()) - mean * mean))};
}

/// Where the first person ends, along x, over so many starts; start(shift) is the model of one from 0 to 19 micrometres aside.
template <class Start>
Spread spread_of(int starts, const Start& start) {
  std::vector<double> ends;
  for (int k = 0; k < starts; ++k) {
    const Model model = start(19e-6 * k / (starts - 1));
    ends.push_back(centre_of_figure(model, engine::simulate(model)).x());
  }
  return spread_of(ends);
}

Spread spread_of(const Peer& peer, const std::string& scene, double step) {
  std::vector<double> ends;
  for (int k = 0; k < 20; ++k)
    ends.push_back(
        peer_value(peer, fmt::format("scene={} dt={} reps=1 pert={} damp={}", scene, step, k, kDampingOfComparison), 20));
  return spread_of(ends);
}

void damp(Model& model, double damping) {  // [N m s/rad]
  for (engine::Joint& joint : model.joints)
    for (engine::JointCoordinate& angle : joint.angles) angle.damping = damping;
}

/// Of a common scene with joints damped as in the comparison, shifted or tilted; `change` is made to each start.
enum class Aside { shifted, tilted };
template <class Change>
Spread spread(const std::string& scene, double step, Aside aside, int starts, const Change& change) {
  return spread_of(starts, [&](double by) {
    Model model = benchmark::common_scene(scene, step, aside == Aside::shifted ? by : 0);
    damp(model, kDampingOfComparison);
    if (aside == Aside::tilted) benchmark::tilt(model, by);
    change(model);
    return model;
  });
}

void ensemble(const std::vector<Peer>& peers) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::printf("Twenty starts shifted by 0 to 19 micrometres, joints damped by 0.1 N m s/rad as in the comparison\n");
  const auto as_it_is = [](Model&) {};
  for (const std::string scene : {"throw", "vehicle"})
    for (const double step : {1e-3, 8e-4, 5e-4}) {
      const Spread s = spread(scene, step, Aside::shifted, 20, as_it_is);
      std::printf("%-8s step %.2g ms: mean %.4f m, standard deviation %.2f mm", scene.c_str(), step * 1e3, s.mean,
                  1e3 * s.deviation);
      for (const Peer& peer : peers) std::printf(", %s %.1f mm", peer.name.c_str(), 1e3 * spread_of(peer, scene, step).deviation);
      std::printf("\n");
    }
  const auto tilted = [](const std::string& scene, double step, const auto& change, int starts = 20) {
    return 1e3 * spread(scene, step, Aside::tilted, starts, change).deviation;
  };
  std::printf("The same, tilted by 0 to 19 microradians instead: standard deviation\n");
  for (const std::string scene : {"throw", "vehicle"})
    for (const double step : {1e-3, 5e-4})
      std::printf("%-8s step %.2g ms: %.2f mm\n", scene.c_str(), step * 1e3, tilted(scene, step, as_it_is));
  std::printf("Tilted, step 1 ms\n");
  for (const std::string scene : {"throw", "vehicle"})
    std::printf("%-8s segments as capsules: %.2f mm\n", scene.c_str(), tilted(scene, 1e-3, benchmark::give_capsules));
  const auto tight = [](Model& m) { m.settings.solver_tolerance = 1e-8; };
  std::printf("vehicle, solver tolerance 1e-8 m/s: %.2f mm\n", tilted("vehicle", 1e-3, tight));
  const auto apart = [](Model& m) { m.settings.effects["self_contact"] = engine::Force::off; };
  std::printf("vehicle, no contact between the figure's own parts: %.2f mm\n", tilted("vehicle", 1e-3, apart));
  const auto damped = [](double damping) { return [damping](Model& m) { damp(m, damping); }; };
  for (const double damping : {0.5, 2.0})
    std::printf("vehicle, joints damped by %g N m s/rad: %.2f mm\n", damping, tilted("vehicle", 1e-3, damped(damping)));
  for (const std::string scene : {"throw", "vehicle"})
    for (const double damping : {0.1, 2.0}) {
      std::printf("%-8s joints damped by %g N m s/rad, ten starts:", scene.c_str(), damping);
      for (const double speed : {8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0}) {
        const auto at_speed = [&](Model& m) {
          damp(m, damping);
          for (engine::Body& body : m.bodies)
            if (body.V_WB.v.x() > 0) body.V_WB.v.x() = speed;
        };
        std::printf(" %g m/s %.1f mm", speed, tilted(scene, 1e-3, at_speed, 10));
      }
      std::printf("\n");
    }
  const Model pedestrian = pedestrian_case();
  const Spread s = spread_of(20, [&](double shift) {
    Model model = pedestrian;
    for (const int b : model.persons.front().bodies) model.bodies[b].X_WB.p.y() += shift;
    return model;
  });
  std::printf("cases/sedan_pedestrian_40kmh shifted: mean %.4f m, standard deviation %.2f mm\n", s.mean, 1e3 * s.deviation);
  std::printf("\n");
}

/// The same fifty persons by themselves, in groups and all at once; of each the quickest of some rounds, as other work only ever
/// adds.
void persons() {
  constexpr int kMost = 50, kRounds = 5;
  constexpr int kCounts[] = {1, 2, 5, 20, kMost};
  std::printf("Cost of a step against the number of persons [microseconds a person]\n%-8s", "");
  for (const int count : kCounts) std::printf(" %7d", count);
  std::printf("   largest over smallest\n");
  for (const std::string what : {"lying", "thrown", "struck"}) {
    double costs[std::size(kCounts)];
    std::fill(std::begin(costs), std::end(costs), std::numeric_limits<double>::infinity());
    for (int round = 0; round < kRounds; ++round)
      for (std::size_t i = 0; i < std::size(kCounts); ++i) {
        double steps = 0, taken = 0;
        for (int done = 0; done < kMost; done += kCounts[i]) {
          const Model model = benchmark::crowd(what, done, std::min(kCounts[i], kMost - done), 1e-3);
          const double start = now();
          steps += static_cast<double>(model.persons.size()) * static_cast<double>(engine::simulate(model).steps);
          taken += now() - start;
        }
        costs[i] = std::min(costs[i], 1e6 * taken / steps);
      }
    std::printf("%-8s", what.c_str());
    for (const double cost : costs) std::printf(" %7.1f", cost);
    const auto [least, most] = std::minmax_element(std::begin(costs), std::end(costs));
    std::printf("   %.2f\n", *most / *least);
    std::fflush(stdout);
  }
  std::printf("\n");
}

void triangles() {
  std::printf("Cost of a step against the triangles of the vehicle\n");
  double first = 0;
  for (const int count : {1000, 10000, 100000, 1000000}) {
    const Timed t = timed(benchmark::struck_by_mesh(count, 1e-3), 3);
    const double cost = 1e6 * t.wall_s / static_cast<double>(t.run.steps);
    if (first == 0) first = cost;
    std::printf("%8d triangles: %7.1f us a step, %.2f times the first\n", count, cost, cost / first);
    std::fflush(stdout);
  }
  std::printf("\n");
}

/// What is not called for costs nothing: one falling ball, a person who still waits, a person in contact.
void plan() {
  Model ball = benchmark::common_scene("flight", 1e-3);
  ball.bodies.resize(1);
  ball.bodies[0].person = -1;
  ball.joints.clear();
  ball.persons.clear();
  ball.settings.effects.clear();
  Model waiting = benchmark::crowd("struck", 0, 1, 1e-3);
  waiting.persons[0].zero_condition = true;
  waiting.bodies.pop_back();  // the car
  waiting.vehicles.clear();
  const Model contact = benchmark::common_scene("vehicle", 1e-3);
  const Model flagship = pedestrian_case();
  auto cost = [](const Timed& t) { return 1e6 * t.wall_s / static_cast<double>(t.run.steps); };
  const double one = cost(timed(ball, 9)), idle = cost(timed(waiting, 9)), full = cost(timed(contact, 5));
  const double whole = cost(timed(flagship, 5));
  std::printf("One ball %.3f us a step, a waiting person %.3f us, a struck person %.1f us, the pedestrian case %.1f us\n", one,
              idle, full, whole);
  std::printf("The case costs %.0f times the ball; waiting costs %.4f of being struck\n\n", whole / one, idle / full);
}

/// A car that drives, and persons who stand 900 m ahead of it, so far [m] beside each other.
Model waiting_scene(int persons, double apart, const char* interval) {
  std::string text = fmt::format("[simulation]\nduration = \"20 s\"\nrecord_interval = \"{}\"\n", interval);
  text += "[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\nspeed = \"50 km/h\"\n";
  for (int p = 0; p < persons; ++p) text += fmt::format("[[person]]\nname = \"p{}\"\nposition = \"900 {} m\"\n", p, p * apart);
  return scenes::load(scenes::SceneFile{scenes::home_folder() / "waiting.toml", text, {}}).model;
}

/// What a step takes [us], without the run's start: the quicker quarter of its hundreds, as others' work only ever adds.
double cost_of_step(const Model& model) {
  std::vector<double> times;
  double last = 0;
  engine::RunOptions options;
  options.progress = [&](double) {
    const double time = now();
    if (last > 0) times.push_back(1e6 * (time - last) / 100);
    last = time;
    return true;
  };
  engine::simulate(model, options);
  const auto quarter = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 4);
  std::nth_element(times.begin(), quarter, times.end());
  return *quarter;
}

/// What who waits adds to a step: medians of rounds in which none, one and ten follow each other.
void waiting() {
  struct Row {
    const char* interval;
    double apart;  // [m]: within arm's reach no proof leaves out that they touch
  };
  constexpr int kRounds = 25;
  std::printf("A car by itself, and what persons who wait 900 m ahead add to its step\n");
  for (const auto& [interval, apart] : {Row{"5 ms", 5}, Row{"5 ms", 1}, Row{"1 s", 5}}) {
    std::vector<double> none, one, ten;  // [us] a step; one and ten: what they add
    for (int round = 0; round < kRounds; ++round) {
      none.push_back(cost_of_step(waiting_scene(0, apart, interval)));
      one.push_back(cost_of_step(waiting_scene(1, apart, interval)) - none.back());
      ten.push_back(cost_of_step(waiting_scene(10, apart, interval)) - none.back());
    }
    const double alone = median(none), by_one = median(one), by_ten = median(ten);
    std::printf("recorded every %s, %g m apart: %.3f us; one adds %.3f us (times %.3f), ten add %.3f us (times %.3f)\n", interval,
                apart, alone, by_one, 1 + by_one / alone, by_ten, 1 + by_ten / alone);
    std::fflush(stdout);
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> parts;
  std::vector<Peer> peers;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "--peer" && i + 1 < argc) {
      const std::string peer = argv[++i];
      const auto equals = peer.find('=');
      peers.push_back({peer.substr(0, equals), peer.substr(equals + 1)});
    } else {
      parts.push_back(arg);
    }
  }
  auto wanted = [&](const char* part) { return parts.empty() || std::find(parts.begin(), parts.end(), part) != parts.end(); };
  if (wanted("scenes")) common_scenes(peers);
  if (wanted("whole")) benchmark::whole_runs();
  if (wanted("throughput")) benchmark::throughput();
  if (wanted("ensemble")) ensemble(peers);
  if (wanted("persons")) persons();
  if (wanted("triangles")) triangles();
  if (wanted("plan")) plan();
  if (wanted("waiting")) waiting();
  if (wanted("dense")) dense_algebra_beside_eigen();
  if (wanted("lockstep")) runs_in_lockstep();
}
