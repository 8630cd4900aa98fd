// A planted contradiction: the head of a child before a high bonnet is said to have marked the windscreen, which no speed brings it
// to.
//   contradiction [runs] [cases]
// The runs of one plan are the table; each case takes one of them as truth, blurs its throw and head mark by their tolerances, and
// is concluded twice: as it is, and with the mark on the windscreen. Prints both counts; ends with 1 when fewer than 19 of 20 are
// found.
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <filesystem>

#include "cli/inference/ensemble.h"
#include "cli/inference/fit.h"
#include "cli/inference/sample.h"
#include "cli/inference/sequence.h"

namespace {

using namespace cli::inference;
using scenes::Evidence;

double deviate(std::uint64_t number) {
  return normal_score((static_cast<double>(mixed(number) >> 11) + 0.5) * 0x1p-53);
}

/// The mark as the scene has it lies on the windscreen, 1.3 m above the road; a child's head comes to the bonnet.
std::vector<Evidence> blurred(const std::vector<Evidence>& planted, const Row& truth, std::uint64_t number, bool on_windscreen) {
  std::vector<Evidence> out(planted);
  for (std::size_t e = 0; e < out.size(); ++e)
    for (std::size_t k = 0; k < out[e].value.size(); ++k) {
      if (!on_windscreen || e == 0) out[e].value[k] = (*truth.answer.predicted[e])[k];
      out[e].value[k] += out[e].tolerance * deviate(number * 101 + e * 11 + k);
    }
  return out;
}

bool contradicts(const Prior& prior, const std::vector<Evidence>& evidence, Table table) {
  judge(evidence, table);
  const std::vector<double> ratios(table.rows.size(), 0.0);
  return conclude(prior, evidence, std::move(table), ratios, 1).contradiction;
}

int run(int runs, int cases) {
  const scenes::Scene scene =
      scenes::load(std::filesystem::path(CRASHREEL_SOURCE_DIR) / "tests/inference/child_before_bonnet.toml");
  const auto& planted = scene.inference.evidence;
  const Prior prior(scene.inference.uncertain);
  Table table = plan_rows(prior, {}, static_cast<std::uint64_t>(runs), 1);
  std::vector<std::vector<std::string>> overrides;
  for (const Row& row : table.rows) overrides.push_back(overrides_of(prior, table, row));
  const auto folder = std::filesystem::temp_directory_path() / "crashreel_contradiction";
  const std::vector<Answer> answers = Ensemble(scene, {folder, 2, cli::ShowProgress::automatic, "run", ""}).run(overrides);
  for (std::size_t i = 0; i < answers.size(); ++i) table.rows[i].answer = answers[i];

  int tried = 0, found = 0, invented = 0;
  for (std::size_t i = 0; i < table.rows.size() && tried < cases; ++i) {
    const Row& truth = table.rows[i];
    if (!truth.answer.ok() || !truth.answer.predicted[0] || !truth.answer.predicted[1]) continue;
    ++tried;
    found += contradicts(prior, blurred(planted, truth, i, true), table);
    invented += contradicts(prior, blurred(planted, truth, i, false), table);
  }
  fmt::print("{} runs: head mark on the windscreen is told as a contradiction in {} of {}; the true marks in {}\n", runs, found,
             tried, invented);
  return tried == cases && 20 * found >= 19 * cases ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
  return run(argc > 1 ? std::atoi(argv[1]) : 256, argc > 2 ? std::atoi(argv[2]) : 20);
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
