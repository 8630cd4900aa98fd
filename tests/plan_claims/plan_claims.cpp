// What a plan says against runs that know better.
//
//     plan_claims idle SCENE...              effects that were on though the run is the same, bit for bit, without them
//     plan_claims random COUNT [SEED]        odd scenes with every effect forced on: nothing acts before its proof, and the run is
//                                            the one with the plan
//     --window SECONDS                       of a run at most
//
// Exit code 1 where more than a tenth is idle, or a claim does not hold.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/plan.h"
#include "engine/simulate.h"
#include "scenes/scene.h"
#include "tests/odd_scenes/generator.h"

namespace {

using engine::Force;
using engine::Model;
using engine::PlanLine;
using engine::Recording;

/// An effect that never had anything within its reach: `plan --measure` says that it waited.
bool waited(const PlanLine& line) {
  return line.acted.told && line.acted.in_reach < 0;
}

/// Strictly: who waits counts as idle too.
int count_idle(const std::vector<std::string>& scenes, double window) {
  int on = 0, waiting = 0, idle = 0;
  for (const std::string& path : scenes) {
    Model model = scenes::load(path, {}).model;
    model.settings.duration = std::min(model.settings.duration, window);
    const Recording run = engine::simulate(model);
    std::string names;
    int here = 0;
    for (const PlanLine& line : run.plan) {
      if (!line.active || line.forced) continue;
      ++here;
      Model without = model;
      without.settings.effects[line.effect] = Force::off;
      if (engine::hash(engine::simulate(without)) != engine::hash(run)) continue;
      ++(waited(line) ? waiting : idle);
      names += " " + line.effect + (waited(line) ? " (waited)" : "");
    }
    on += here;
    std::printf("%-44s %2d on%s%s\n", std::filesystem::path(path).filename().c_str(), here,
                names.empty() ? "" : ", the same without", names.c_str());
    std::fflush(stdout);
  }
  const int same = waiting + idle;
  std::printf("%d effects on; the run is the same without %d (%.1f %%): %d had nothing in reach, %d were idle\n", on, same,
              on > 0 ? 100.0 * same / on : 0.0, waiting, idle);
  return 10 * same > on ? 1 : 0;
}

/// False, and a line, where a claim of the scene's plan does not hold.
bool holds(const odd::OddScene& odd, std::uint64_t seed, int& proofs) {
  const Model& model = odd.scene.model;
  Model forced = model;
  const engine::Plan plan = engine::compile(model);
  for (const PlanLine& line : plan.lines)
    if (!line.forced) forced.settings.effects[line.effect] = Force::on;  // what the author decides is no claim of the plan
  const Recording with_all = engine::simulate(forced), planned = engine::simulate(model);
  bool good = engine::hash(with_all) == engine::hash(planned);
  if (!good) std::printf("seed %llu: the plan leaves out what matters\n", static_cast<unsigned long long>(seed));
  for (std::size_t i = 0; i < plan.lines.size(); ++i) {
    const PlanLine &claim = plan.lines[i], &seen = with_all.plan[i];
    proofs += claim.not_before > 0;
    if (!(seen.acted.first >= 0 && seen.acted.first < claim.not_before)) continue;
    good = false;
    std::printf("seed %llu: %s acted at %.6g s, not before %.6g s by its proof\n", static_cast<unsigned long long>(seed),
                claim.effect.c_str(), seen.acted.first, claim.not_before);
  }
  return good;
}

int try_random(int count, std::uint64_t seed, double window) {
  std::vector<odd::Generator::Base> bases;
  for (const char* folder : {"tests/odd_scenes/bases", "scenes/gallery"})
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(CRASHREEL_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".toml") bases.push_back({entry.path(), 1});
  std::sort(bases.begin(), bases.end(), [](const auto& a, const auto& b) { return a.file < b.file; });
  const odd::Generator generator(bases);
  int wrong = 0, proofs = 0;
  for (int i = 0; i < count; ++i)
    wrong += !holds(generator.make(seed + static_cast<std::uint64_t>(i), window), seed + static_cast<std::uint64_t>(i), proofs);
  std::printf("%d scenes, %d proofs, %d claims that do not hold\n", count, proofs, wrong);
  return wrong > 0 ? 1 : 0;
}

}  // namespace

int main(int count, char** arguments) {
  double window = 1e9;
  std::vector<std::string> words;
  for (int i = 1; i < count; ++i) {
    const std::string word = arguments[i];
    if (word == "--window" && i + 1 < count)
      window = std::atof(arguments[++i]);
    else
      words.push_back(word);
  }
  if (words.size() > 1 && words[0] == "idle") return count_idle({words.begin() + 1, words.end()}, window);
  if (words.size() > 1 && words[0] == "random")
    return try_random(std::atoi(words[1].c_str()), words.size() > 2 ? std::strtoull(words[2].c_str(), nullptr, 10) : 1,
                      std::min(window, 0.3));
  std::puts("plan_claims idle SCENE... | random COUNT [SEED]   [--window SECONDS]");
  return 2;
}
