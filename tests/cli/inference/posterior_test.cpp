// The mathematics of a fit, on runs whose outcome is a formula: nothing is simulated, so that thousands of cases are cheap.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cli/inference/fit.h"
#include "cli/inference/proposal.h"
#include "cli/inference/sequence.h"

namespace cli_tests {
namespace {

using namespace cli::inference;

scenes::Uncertain uniform(const std::string& key, double low, double high) {
  scenes::Uncertain u;
  u.key = key;
  u.numbers = {low, high};
  return u;
}

scenes::Evidence seen(const std::string& name, double value, double tolerance) {
  scenes::Evidence e;
  e.name = name;
  e.metric = name;
  e.value = {value};
  e.tolerance = tolerance;
  return e;
}

using Formula = std::function<std::vector<double>(const std::vector<double>& inputs)>;

/// A plan of the prior with the formula's answers, one for each piece of evidence.
Table plan(const Prior& prior, int runs, std::uint64_t seed, const Formula& formula) {
  Table out;
  for (const auto& u : scrambled_points(prior.size(), 0, static_cast<std::uint64_t>(runs), seed)) {
    Row row;
    for (const double x : u) row.scores.push_back(normal_score(x));
    row.values = prior.values(row.scores);
    for (const double p : formula(row.values)) row.answer.predicted.emplace_back(std::vector<double>{p});
    out.rows.push_back(std::move(row));
  }
  return out;
}

/// Slide to stop and a recorded speed: inputs are speed and friction.
std::vector<double> slide(const std::vector<double>& x) {
  return {x[0] * x[0] / (2 * x[1] * 9.81), x[0]};
}

TEST(Coverage, NinetyPercentIntervalsHoldTheTruthInNinetyOfAHundred) {
  const Prior prior({uniform("speed", 10, 20), uniform("friction", 0.5, 0.8)});
  const Table table = plan(prior, 2048, 3, slide);
  for (const Calibration& c : calibrate(prior, {seen("slide", 0, 1.5), seen("recorder", 0, 1.5)}, table, 500, 4)) {
    EXPECT_EQ(c.cases, 500);
    EXPECT_GE(c.inside_90, 433) << c.key;  // the band of a binomial in 99 of 100
    EXPECT_LE(c.inside_90, 467) << c.key;
    EXPECT_LT(c.chi_squared, 21.7) << c.key;  // 9 degrees of freedom, 99 of 100
    EXPECT_GT(c.median_effective, 50) << c.key;
  }
}

Fit conclude_from_prior(const Prior& prior, const std::vector<scenes::Evidence>& evidence, int runs, std::uint64_t seed,
                        const Formula& formula) {
  Table table = plan(prior, runs, seed, formula);
  judge(evidence, table);
  const std::vector<double> ratios(table.rows.size(), 0.0);
  return conclude(prior, evidence, std::move(table), ratios, seed);
}

TEST(Contradiction, IsFoundWhereItIsPlantedAndSeldomElsewhere) {
  const Prior prior({uniform("speed", 10, 20), uniform("friction", 0.5, 0.8)});
  int found = 0, invented = 0;
  for (std::uint64_t c = 0; c < 20; ++c) {
    const auto u = scrambled_points(2, c, 1, 99)[0];
    const std::vector<double> truth = {10 + 10 * u[0], 0.5 + 0.3 * u[1]};
    const std::vector<double> at = slide(truth);
    const auto noise = [&](std::uint64_t k) { return normal_score((static_cast<double>(mixed(c * 7 + k) >> 11) + 0.5) * 0x1p-53); };
    const double d = at[0] + 0.5 * noise(1), v = at[1] + 0.3 * noise(2);
    // no friction between 0.5 and 0.8 brings a car of this recorded speed so far
    const double too_far = v * v / (2 * 0.5 * 9.81) + 6;
    found += conclude_from_prior(prior, {seen("slide", too_far, 0.5), seen("recorder", v, 0.3)}, 2048, 5, slide).contradiction;
    invented += conclude_from_prior(prior, {seen("slide", d, 0.5), seen("recorder", v, 0.3)}, 2048, 5, slide).contradiction;
  }
  EXPECT_GE(found, 19);
  EXPECT_LE(invented, 2);  // one in a hundred by chance, and what noise puts beyond the ends of the prior
}

TEST(Sampling, WeighsANarrowPosteriorExactly) {
  // p = standard normal, L = exp(-(z - m)^2 / (2 s^2)) in each of three scores: a normal with mean m/(1 + s^2), variance s^2/(1 +
  // s^2)
  const double m = 2, s = 0.1;
  const auto log_l = [&](const std::vector<double>& z) {
    double sum = 0;
    for (const double x : z) sum -= 0.5 * (x - m) * (x - m) / (s * s);
    return sum;
  };
  Mixture mixture;
  Scores points = Proposal(3).draw(512, 1);
  mixture.add(Proposal(3), points);
  for (std::uint64_t round = 0; round < 4; ++round) {
    std::vector<double> logs;
    for (const auto& z : mixture.points()) logs.push_back(log_l(z));
    Proposal next(mixture.points(), normalised(tempered(mixture.log_ratios(), logs, 70)), round);
    points = next.draw(512, round + 10);
    mixture.add(std::move(next), points);
  }
  std::vector<double> logs = mixture.log_ratios(), first;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    logs[i] += log_l(mixture.points()[i]);
    first.push_back(mixture.points()[i][0]);
  }
  const Weighted w = normalised(logs);
  const double sd = s / std::sqrt(1 + s * s);
  EXPECT_GT(w.effective, 100);
  // four deviations of the mean and of the deviation over so many effective points
  EXPECT_NEAR(mean_of(first, w.weights), m / (1 + s * s), 4 * sd / std::sqrt(w.effective));
  EXPECT_NEAR(sd_of(first, w.weights), sd, 4 * sd / std::sqrt(2 * w.effective));
}

TEST(Sampling, AScatterOfNearStartsWidensTheAnswerAsItShould) {
  // the outcome is the input plus a chaotic part: 0.5 sin(1e6 x), of variance 1/8; seen 0 with tolerance 0.2
  const Prior prior({uniform("x", -4, 4)});
  const Formula chaotic = [](const std::vector<double>& x) { return std::vector<double>{x[0] + 0.5 * std::sin(1e6 * x[0])}; };
  const Fit fit = conclude_from_prior(prior, {seen("y", 0, 0.2)}, 8192, 2, chaotic);
  // x = y - chaos - error: the variances add
  EXPECT_NEAR(fit.inputs[0].sd, std::sqrt(0.125 + 0.04), 0.02);
  EXPECT_NEAR(fit.inputs[0].mean, 0, 0.05);
}

TEST(Modes, AreHillsAndNotRipples) {
  const auto sample = [](double a, double b, double width, double share) {
    std::vector<double> out;
    for (const auto& u : scrambled_points(2, 0, 1000, 8)) out.push_back((u[0] < share ? a : b) + width * normal_score(u[1]));
    return out;
  };
  const auto count = [](const std::vector<double>& values) {
    return modes_of(values, normalised(std::vector<double>(values.size(), 0.0))).size();
  };
  EXPECT_EQ(count(sample(0, 0, 1, 0.5)), 1u);
  EXPECT_EQ(count(sample(-5, 5, 0.3, 0.5)), 2u);
  EXPECT_EQ(count(sample(-5, 5, 0.3, 0.02)), 1u);  // two in a hundred are told by the interval's tail, not as an answer
  EXPECT_EQ(count(sample(-1, 1, 1, 0.5)), 1u);     // hills that have grown together
  std::vector<double> even;
  for (int i = 0; i < 1000; ++i) even.push_back(i);
  EXPECT_EQ(count(even), 1u);
}

TEST(Modes, OfManySamplesOfOneHillAreOne) {
  int wrong = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    std::vector<double> values;
    for (std::uint64_t i = 0; i < 300; ++i)
      values.push_back(normal_score((static_cast<double>(mixed(mixed(seed) + i) >> 11) + 0.5) * 0x1p-53));
    wrong += modes_of(values, normalised(std::vector<double>(values.size(), 0.0))).size() != 1;
  }
  EXPECT_LE(wrong, 2);
}

TEST(Quantiles, OfWeightsAreThoseOfRepetition) {
  EXPECT_DOUBLE_EQ(quantile_of({1, 2, 3}, {1, 1, 1}, 0.5), 2);
  EXPECT_DOUBLE_EQ(quantile_of({3, 1, 2}, {0, 1, 1}, 0.5), 1.5);
  EXPECT_DOUBLE_EQ(quantile_of({1, 2}, {0.25, 0.75}, 0.625), 2);
  EXPECT_EQ(piled_at_end({0.01, 0.02, 0.5}, {0.4, 0.4, 0.2}), -1);
  EXPECT_EQ(piled_at_end({0.1, 0.5, 0.9}, {0.3, 0.4, 0.3}), 0);
}

}  // namespace
}  // namespace cli_tests
