// Not a test: studies random variants of the five gallery scenes whose answers are known, without telling the study the answers.
// How often does the printed band hold the true error, how near is the printed error to it, and what order is observed?
//
//     benchmark_study [VARIANTS] [SEED]
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <random>

#include "cli/study/pool.h"
#include "cli/study/run.h"
#include "tests/benchmark/exact_answers.h"

namespace {

using Overrides = std::vector<std::string>;
using Answers = std::map<std::string, double>;  // by quantity

struct Variant {
  const char* scene;
  Overrides overrides;
  Answers exact;
};

class Chance {
 public:
  explicit Chance(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }

 private:
  std::mt19937_64 engine_;
};

std::string duration(double seconds) {
  return fmt::format("simulation.duration={:.3f} s", std::ceil(seconds / 0.032) * 0.032);
}

Variant projectile(Chance& draw) {
  const double v = draw(6, 14), angle = draw(10, 40) * std::numbers::pi / 180, height = draw(0.5, 1.5), mu = draw(0.3, 0.8);
  const double vx = v * std::cos(angle), vz = v * std::sin(angle), rest = exact::projectile_rest(vx, vz, height, mu);
  return {"projectile_slide",
          {fmt::format("body.stone.velocity={} 0 {} m/s", vx, vz), fmt::format("body.stone.position=0 0 {} m", height + 0.01),
           fmt::format("body.stone.friction={}", mu), duration(rest + 0.6)},
          {{"travel_m", exact::projectile_travel(vx, vz, height, mu)}, {"rest_s", rest}}};
}

Variant pendulum(Chance& draw) {
  const double angle = draw(5, 80), a = angle * std::numbers::pi / 180, t = std::ceil(draw(1, 4) / 0.032) * 0.032;
  const double inertia = 0.1666667, mass = 2, l = 0.5;
  const double end = exact::pendulum_angle(a, std::sqrt(mass * exact::kGravity * l / (inertia + mass * l * l)), t);
  return {"pendulum",
          {fmt::format("body.rod.position={} 0 {} m", -l * std::sin(a), 1.5 - l * std::cos(a)),
           fmt::format("body.rod.attitude=0 {} 0 deg", angle), duration(t)},
          {{"travel_m", l * std::abs(std::sin(end) - std::sin(a))}, {"turned_deg", std::abs(end - a) * 180 / std::numbers::pi}}};
}

Variant free_body(Chance& draw) {
  const double I[3] = {0.03, 0.06, 0.08}, w[3] = {draw(0.01, 1), draw(3, 6), draw(-1, 1)};
  const double t = std::ceil(draw(2, 10) / 0.032) * 0.032;
  return {"free_body",
          {fmt::format("body.body.angular_velocity_body={} {} {} rad/s", w[0], w[1], w[2]), duration(t)},
          {{"turned_deg", exact::free_body_turned(I, w, t) * 180 / std::numbers::pi}}};
}

Variant ball(Chance& draw) {
  const double e = draw(0.2, 0.9), height = draw(0.5, 2), own = 1e3 * std::pow(10, draw(1.3, 4));
  const double stiffness = own * 100e6 / (own + 100e6);
  return {"ball_compliant",
          {fmt::format("body.ball.restitution={}", e), fmt::format("body.ball.position=0 0 {} m", height + 0.1),
           fmt::format("body.ball.stiffness={} N/m", own), duration(2 * std::sqrt(2 * height / exact::kGravity) + 0.3)},
          {{"rebound_height_m", exact::ball_rebound(e, height, 1, stiffness)}}};
}

Variant puck(Chance& draw) {
  const double v = draw(5, 15), mu = draw(0.3, 0.8), rest = exact::puck_rest(v, mu);
  return {"puck_slide",
          {fmt::format("body.puck.velocity={} 0 0 m/s", v), fmt::format("body.puck.friction={}", mu), duration(rest + 0.5)},
          {{"travel_m", exact::puck_travel(v, mu)}, {"rest_s", rest}}};
}

struct Tally {
  int answers = 0, covered = 0;  // at the scene's own step
  int levels = 0, levels_covered = 0;
  int told = 0, agreed = 0;  // errors larger than what the settings besides the step leave open
  std::vector<double> orders;
};

void judge(const cli::study::Study& study, const Variant& variant, Tally& tally) {
  for (const auto& [quantity, exact] : variant.exact) {
    const cli::study::Judgement* j = study.find(quantity);
    if (!j) {
      fmt::print("{}: no {} ({})\n", variant.scene, quantity, fmt::join(variant.overrides, ", "));
      continue;
    }
    if (std::isfinite(j->convergence.order)) tally.orders.push_back(j->convergence.order);
    for (const cli::study::SettingResult& r : study.series.front().settings) {
      const cli::study::Answer* a = cli::study::answer_of(r, quantity);
      if (!a) continue;
      const double error = a->value - exact;
      // the formulas' own digits: 1e-11 of the answer
      const bool covered = std::abs(error) <= a->uncertainty + 1e-11 * std::abs(exact);
      ++tally.levels;
      tally.levels_covered += covered;
      if (std::abs(error) > j->beside_the_step() + 1e-10 * std::abs(exact)) {
        ++tally.told;
        tally.agreed += std::abs(a->error - error) <= 0.2 * std::abs(error);
      }
      if (!r.setting.own) continue;
      ++tally.answers;
      tally.covered += covered;
      if (!covered)
        fmt::print("not covered: {} {}: error {:.3g}, band {:.3g} ({}; {})\n", variant.scene, quantity, error, a->uncertainty,
                   j->error_kind, fmt::join(variant.overrides, ", "));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int variants = argc > 1 ? std::atoi(argv[1]) : 200;
  Chance draw(argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1);
  constexpr Variant (*kScenes[])(Chance&) = {projectile, pendulum, free_body, ball, puck};
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("crashreel_study_{}", static_cast<long>(getpid()));
  std::map<std::string, Tally> tallies;
  std::filesystem::create_directory(folder);
  for (int i = 0; i < variants; ++i) {
    const Variant variant = kScenes[i % 5](draw);
    scenes::Scene scene =
        scenes::load(std::string(CRASHREEL_SOURCE_DIR) + "/scenes/gallery/" + variant.scene + ".toml", variant.overrides);
    scene.closed_form.clear();
    cli::study::RunWish wish;
    wish.options.members = 0;
    wish.folder = folder;
    wish.jobs = cli::study::available_cores();
    wish.timed = false;
    wish.show = cli::ShowProgress::never;
    judge(cli::study::run_study(scene, wish), variant, tallies[variant.scene]);
    std::filesystem::remove_all(folder / "runs");
  }
  std::filesystem::remove_all(folder);
  fmt::print("{:<18} {:>8} {:>8} {:>12} {:>22}  {}\n", "scene", "answers", "covered", "all levels", "error within 20 %",
             "order, median of those observed");
  for (auto& [scene, t] : tallies) {
    std::sort(t.orders.begin(), t.orders.end());
    fmt::print("{:<18} {:>8} {:>8} {:>12} {:>22}  {}\n", scene, t.answers, t.covered,
               fmt::format("{}/{}", t.levels_covered, t.levels), fmt::format("{}/{}", t.agreed, t.told),
               t.orders.empty() ? "none" : fmt::format("{:.2f}", t.orders[t.orders.size() / 2]));
  }
  return 0;
}
