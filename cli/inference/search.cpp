#include "cli/inference/search.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/inference/proposal.h"
#include "cli/inference/sequence.h"

namespace cli::inference {
namespace {

constexpr int kRounds = 4;         // after the prior
constexpr double kWell = 1.0 / 3;  // of the runs effective: more runs would not say more
constexpr double kFewest = 40;     // effective points a proposal is made from, and
constexpr double kPerInput = 10;   // so many more for each input

void append(const scenes::Scene& scene, const Prior& prior, const Scores& points, Ensemble& ensemble, const std::string& stage,
            Table& table) {
  Table batch;
  std::vector<std::vector<std::string>> overrides;
  for (const std::vector<double>& z : points) {
    Row row;
    row.scores = z;
    row.values = prior.values(z);
    overrides.push_back(prior.overrides(row.values));
    batch.rows.push_back(std::move(row));
  }
  std::vector<Answer> answers = ensemble.run(overrides, stage);
  for (std::size_t i = 0; i < answers.size(); ++i) batch.rows[i].answer = std::move(answers[i]);
  judge(scene.inference.evidence, batch);
  std::move(batch.rows.begin(), batch.rows.end(), std::back_inserter(table.rows));
}

std::vector<double> likelihoods(const Table& table) {
  std::vector<double> out;
  for (const Row& row : table.rows) out.push_back(log_likelihood(row));
  return out;
}

}  // namespace

Search search(const scenes::Scene& scene, const Prior& prior, Ensemble& ensemble, const SearchWish& wish) {
  Search out;
  Mixture mixture;
  Scores points = scrambled_points(prior.size(), 0, static_cast<std::uint64_t>(std::max(1, wish.runs / 2)), wish.seed);
  for (auto& point : points)
    for (double& u : point) u = normal_score(u);
  append(scene, prior, points, ensemble, "first half", out.table);
  out.from_prior = points.size();
  mixture.add(Proposal(prior.size()), points);
  out.log_ratios = mixture.log_ratios();
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<double> logs = likelihoods(out.table);
    const Weighted now = normalised(tempered(out.log_ratios, logs, 0));
    const int left = wish.runs - static_cast<int>(out.table.rows.size());
    if (left <= 0 || now.effective >= std::max(kWell * wish.runs, kEnoughRuns)) break;
    const double wanted = kFewest + kPerInput * prior.size();
    const Weighted wide =
        normalised(tempered(out.log_ratios, logs, std::min(wanted, 0.3 * static_cast<double>(out.table.rows.size()))));
    if (!(wide.effective > 1)) break;  // no run explains anything: more of them would not either
    const std::uint64_t seed = mixed(wish.seed + static_cast<std::uint64_t>(round) + 1);
    Proposal proposal(mixture.points(), wide, seed);
    points = proposal.draw(static_cast<std::uint64_t>(std::max(1, left / (kRounds - round))), seed);
    append(scene, prior, points, ensemble, fmt::format("round {} of {}", round + 1, kRounds), out.table);
    mixture.add(std::move(proposal), points);
    out.log_ratios = mixture.log_ratios();
  }
  return out;
}

}  // namespace cli::inference
