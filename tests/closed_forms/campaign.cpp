// Studies random scenes whose answers are known, without telling the study. Does the printed band hold the true error at every
// step, and how near is it? Does what --target offers hold what was asked, and is something offered where something holds?
//
//     closed_forms [--scenes 500] [--seed 1] [--only SEED] [--family NAME] [--check]
//
// --check: exit code 1 where a bound of tests/README.md is missed.
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

#include "cli/study/pool.h"
#include "cli/study/run.h"
#include "cli/study/target.h"
#include "tests/closed_forms/families.h"

namespace {

using cli::study::Study;
using closed_forms::Known;

struct Tally {
  int scenes = 0, answers = 0, covered = 0;  // answers at any step
  int compared = 0, tight = 0;               // errors that are more than rounding; bands of at most three times them
  int offers = 0, held = 0;                  // of --target
  int silent = 0, wrongly_silent = 0;        // nothing offered, though a setting whose own band is no wider holds
};

struct Wish {
  int scenes = 500;
  std::uint64_t seed = 1;
  bool only = false, check = false;
  std::string family;
};

/// The formulas' own digits, and those a scene is written with: a start snapped to a grid of 15 nm.
double rounding(double exact) {
  return 2e-8 + 1e-11 * std::abs(exact);
}

void judge_target(const Study& study, const std::string& quantity, double width, double exact, Tally& tally) {
  const cli::study::TargetAnswer answer = cli::study::search(study, {quantity, width});
  if (answer.setting) {
    ++tally.offers;
    const double error = std::abs(answer.setting->answers.at(quantity).value - exact);
    const bool held = error <= width + rounding(exact);
    tally.held += held;
    if (!held) fmt::print("  offer for {} = {:.3g} is off by {:.3g}: {}\n", quantity, width, error, answer.setting->setting.label);
    return;
  }
  ++tally.silent;
  for (const auto& series : study.series)
    for (const auto& result : series.settings)
      if (const auto* a = cli::study::answer_of(result, quantity); a && a->uncertainty <= width) {
        ++tally.wrongly_silent;
        fmt::print("  nothing offered for {} = {:.3g}, which {} holds\n", quantity, width, result.setting.label);
        return;
      }
}

void judge(const Study& study, const Known& known, std::uint64_t seed, const char* family, Tally& tally) {
  ++tally.scenes;
  for (const auto& [quantity, exact] : known.answers) {
    const cli::study::Judgement* j = study.find(quantity);
    if (!j) {
      fmt::print("{} {}: no {}\n", family, seed, quantity);
      ++tally.answers;
      continue;
    }
    for (const auto& result : study.series.front().settings) {
      const cli::study::Answer* a = cli::study::answer_of(result, quantity);
      if (!a) continue;
      const double error = std::abs(a->value - exact);
      const bool covered = error <= a->uncertainty + rounding(exact);
      ++tally.answers;
      tally.covered += covered;
      if (!covered)
        fmt::print("{} {}: {} at {}: off by {:.3g}, band {:.3g} ({})\n", family, seed, quantity, result.setting.label, error,
                   a->uncertainty, j->error_kind);
      if (error < rounding(exact)) continue;
      ++tally.compared;
      tally.tight += a->uncertainty <= 3 * error;
    }
    for (const double share : {1e-6, 1e-4, 1e-2})
      judge_target(study, quantity, share * std::max(std::abs(exact), 0.01), exact, tally);
  }
}

Wish wish_of(int count, char** arguments) {
  Wish wish;
  for (int i = 1; i < count; ++i) {
    const std::string word = arguments[i];
    if (word == "--check") wish.check = true;
    if (i + 1 == count) break;
    if (word == "--scenes") wish.scenes = std::atoi(arguments[i + 1]);
    if (word == "--seed") wish.seed = std::strtoull(arguments[i + 1], nullptr, 10);
    if (word == "--only") wish.seed = std::strtoull(arguments[i + 1], nullptr, 10), wish.only = true;
    if (word == "--family") wish.family = arguments[i + 1];
  }
  if (wish.only) wish.scenes = 1;
  return wish;
}

Study study_of(const Known& known, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "scene.toml") << known.scene;
  cli::study::RunWish wish;
  wish.options.members = 0;
  wish.folder = folder;
  wish.jobs = cli::study::available_cores();
  wish.timed = false;
  wish.show = cli::ShowProgress::never;
  Study study = cli::study::run_study(scenes::load(folder / "scene.toml", {}), wish);
  std::filesystem::remove_all(folder);
  return study;
}

std::string share(int part, int whole) {
  return whole == 0 ? "none" : fmt::format("{:>6}/{:<6} {:5.1f} %", part, whole, 100.0 * part / whole);
}

void print_row(const std::string& name, const Tally& t) {
  fmt::print("{:<18} {:>6} {:>22} {:>22} {:>22} {:>12}\n", name, t.scenes, share(t.covered, t.answers), share(t.tight, t.compared),
             share(t.held, t.offers), fmt::format("{} of {}", t.wrongly_silent, t.silent));
}

}  // namespace

int main(int count, char** arguments) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // what has been found stands in a log however the run ends
  const Wish wish = wish_of(count, arguments);
  const auto folder =
      std::filesystem::temp_directory_path() / fmt::format("crashreel_closed_forms_{}", static_cast<long>(getpid()));
  std::map<std::string, Tally> tallies;
  fmt::print("{} scenes, seed {}\n", wish.scenes, wish.seed);
  for (int i = 0; i < wish.scenes; ++i) {
    const std::uint64_t seed = wish.seed + static_cast<std::uint64_t>(i);
    const closed_forms::Family& family = closed_forms::families()[seed % closed_forms::families().size()];
    if (!wish.family.empty() && wish.family != family.name) continue;
    closed_forms::Chance draw(seed);
    const Known known = family.make(draw);
    if (wish.only) fmt::print("{}\n", known.scene);
    judge(study_of(known, folder), known, seed, family.name, tallies[family.name]);
  }
  fmt::print("{:<18} {:>6} {:>22} {:>22} {:>22} {:>12}\n", "family", "scenes", "band holds", "band within 3 errors", "offers hold",
             "left out");
  Tally all;
  for (const auto& [name, t] : tallies) {
    print_row(name, t);
    for (int Tally::*member : {&Tally::scenes, &Tally::answers, &Tally::covered, &Tally::compared, &Tally::tight, &Tally::offers,
                               &Tally::held, &Tally::silent, &Tally::wrongly_silent})
      all.*member += t.*member;
  }
  print_row("all", all);
  const bool good = all.covered >= 0.97 * all.answers && all.held >= 0.99 * all.offers && all.wrongly_silent == 0;
  return wish.check && !good ? 1 : 0;
}
