// Orders, limits and bands on ladders made by hand, whose limit is known.
#include "cli/study/convergence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cli/study/analysis.h"
#include "cli/study/statistics.h"

namespace cli::study {
namespace {

constexpr double kLimit = 17.3;

/// Seven levels from 4 ms, halved, of an answer with the given error.
template <typename Error>
std::vector<Level> ladder(const Error& error) {
  std::vector<Level> out;
  for (int k = 0; k < 7; ++k) {
    const double h = 4e-3 / std::pow(2.0, k);
    out.push_back({h, kLimit + error(h), true});
  }
  return out;
}

TEST(Convergence, FindsOrderAndLimitOfASmoothLadder) {
  for (const double order : {1.0, 2.0, 4.0}) {
    // a next-order term as every real scheme has one: 5 % of the error at the coarsest step
    const auto levels = ladder([&](double h) { return 0.1 * std::pow(h / 4e-3, order) * (1 + 0.05 * h / 4e-3); });
    const Convergence c = converge(levels);
    ASSERT_EQ(c.trust, Trust::steady) << order;
    EXPECT_NEAR(c.order, order, 0.05);
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const double true_error = levels[i].value - kLimit;
      if (std::abs(true_error) < 1e-9) continue;  // below it the seventeen digits of the values decide
      EXPECT_NEAR(c.error[i], true_error, 0.2 * std::abs(true_error)) << order << " level " << i;
      EXPECT_GE(c.band[i], std::abs(true_error)) << order << " level " << i;
    }
  }
}

TEST(Convergence, CallsEqualAnswersExact) {
  const Convergence c = converge(ladder([](double) { return 0.0; }));
  EXPECT_EQ(c.trust, Trust::exact);
  EXPECT_EQ(c.limit, kLimit);
}

TEST(Convergence, PrintsARangeWhereTheErrorHasNoOrder) {
  // the last step that stops a body may be any part of a step late: an error of random phase under an envelope of first order
  std::mt19937 chance(7);
  const auto levels = ladder([&](double h) { return h * (std::uniform_real_distribution<>(-1, 1)(chance)); });
  const Convergence c = converge(levels);
  EXPECT_EQ(c.trust, Trust::range);
  EXPECT_TRUE(std::isnan(c.order));
}

TEST(Convergence, ARangeIsNoWiderThanWhatTheAnswersSpan) {
  std::vector<Level> scattered;
  const double values[] = {0, 10, 2, 8, 3, 7, 5};  // the three finest go to and fro
  for (int k = 0; k < 7; ++k) scattered.push_back({4e-3 / std::pow(2.0, k), values[k], true});
  const Convergence c = converge(scattered);
  ASSERT_EQ(c.trust, Trust::range);
  EXPECT_DOUBLE_EQ(c.band[0], 10);  // from 0 to the farthest of the finer answers
  EXPECT_DOUBLE_EQ(c.band[2], 6);   // from 2 to 8
  EXPECT_DOUBLE_EQ(c.band[6], 2);   // of the three finest: from 5 to 7 and 3
  // those that still go one way have their limit beyond them
  const double drifting[] = {0, 10, 2, 8, 3, 4, 5};
  for (std::size_t k = 0; k < 7; ++k) scattered[k].value = drifting[k];
  EXPECT_DOUBLE_EQ(converge(scattered).band[6], 2 + 2);
  // 3 and 1.5 add up to 1.5 more if they go on halving
  const double closing[] = {0, 10, 2, 20, 14, 17, 18.5};
  for (std::size_t k = 0; k < 7; ++k) scattered[k].value = closing[k];
  EXPECT_DOUBLE_EQ(converge(scattered).band[6], 4.5 + kSafety * 1.5);
}

TEST(Convergence, PrintsARangeWhereTheContactsChange) {
  auto levels = ladder([](double h) { return h; });
  ASSERT_EQ(converge(levels).trust, Trust::steady);
  levels[4].comparable = false;
  EXPECT_EQ(converge(levels).trust, Trust::range);
}

TEST(Convergence, NeedsFourLevelsForAnOrder) {
  auto levels = ladder([](double h) { return h; });
  levels.resize(3);
  EXPECT_EQ(converge(levels).trust, Trust::range);
}

/// Two thirds smooth with a next-order term of either sign, one third of random phase.
std::vector<Level> random_ladder(std::mt19937& chance) {
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(chance); };
  const bool smooth = draw(0, 1) < 0.67;
  const double order = std::vector<double>{1, 2, 4}[static_cast<std::size_t>(draw(0, 2.999))];
  const double size = std::pow(10, draw(-3, 0)), bend = draw(-0.8, 0.8);
  return ladder([&](double h) {
    const double x = h / 4e-3;
    return smooth ? size * std::pow(x, order) * (1 + bend * x) : size * x * draw(-1, 1);
  });
}

TEST(Convergence, BandCoversTheTrueErrorOfNineteenInTwentyRandomLadders) {
  std::mt19937 chance(2024);
  int levels_in_all = 0, covered = 0, own_covered = 0;
  constexpr int kLadders = 200;
  for (int k = 0; k < kLadders; ++k) {
    const auto levels = random_ladder(chance);
    const Convergence c = converge(levels);
    for (std::size_t i = 0; i < levels.size(); ++i) {
      ++levels_in_all;
      covered += c.band[i] >= std::abs(levels[i].value - kLimit);
    }
    own_covered += c.band[2] >= std::abs(levels[2].value - kLimit);  // the scene's own step is the third
  }
  EXPECT_GE(covered, 0.95 * levels_in_all) << covered << " of " << levels_in_all;
  EXPECT_GE(own_covered, 0.95 * kLadders) << own_covered << " of " << kLadders;
}

TEST(Statistics, PercentilesAreLinearBetweenMembers) {
  EXPECT_DOUBLE_EQ(median({3, 1, 2}), 2);
  EXPECT_DOUBLE_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_DOUBLE_EQ(percentile({0, 10}, 0.05), 0.5);
  EXPECT_TRUE(std::isnan(median({})));
}

/// Neither scheme closes in on an answer: the range holds what both say, and is not their ranges put end to end.
TEST(Judge, ARangeOfTwoSchemesIsWhatBothSpan) {
  Study study;
  for (const bool other : {false, true}) {
    SeriesResult ladder;
    ladder.series.steps = true;
    ladder.series.name = other ? "rk4" : "stepping";
    const double travel[] = {14.0, 14.4, 17.4, 15.1, 16.2};
    for (int k = 0; k < 5; ++k) {
      SettingResult result;
      result.setting.fineness = 4e-3 / std::pow(2.0, k);
      const double value = travel[k] + (other ? 0.3 : 0);
      result.answers["travel_m"] = {true, value, value, value, value, 0, 0};
      ladder.settings.push_back(result);
    }
    study.series.push_back(ladder);
  }
  judge(study, {});
  EXPECT_NEAR(study.series[0].settings[0].answers.at("travel_m").uncertainty, 17.4 - 14, 1e-9);
}

/// A head criterion jumps from step to step while the medians of its ensembles stand still: the range holds the runs themselves.
TEST(Judge, ARangeHoldsTheOwnAnswersOfFinerStepsWhereMediansStandStill) {
  Study study;
  SeriesResult ladder;
  ladder.series.steps = true;
  const double own[] = {470, 465, 468, 430, 455}, middle[] = {455, 454, 453, 453.5, 453.2};
  for (int k = 0; k < 5; ++k) {
    SettingResult result;
    result.setting.fineness = 4e-3 / std::pow(2.0, k);
    result.setting.members = 8;
    result.answers["hic15"] = {true, own[k], own[k] - 15, own[k] + 15, middle[k], 0, 0};
    ladder.settings.push_back(result);
  }
  study.series.push_back(ladder);
  judge(study, {});
  const auto width = [&](std::size_t k) { return study.series[0].settings[k].answers.at("hic15").uncertainty; };
  EXPECT_GE(width(2), 468 - 430);
  EXPECT_GE(width(0), 470 - 430);
  EXPECT_GE(width(4), 455 - 430);
}

/// Two angles between 0 and 180 degrees are never farther apart than that, whatever two schemes say.
TEST(Judge, NoErrorIsWiderThanItsMeasure) {
  Study study;
  for (const bool other : {false, true}) {
    SeriesResult ladder;
    ladder.series.steps = true;
    ladder.series.name = other ? "rk4" : "stepping";
    const double turned[] = {20, 170, 30, 160, 100};
    for (int k = 0; k < 5; ++k) {
      SettingResult result;
      result.setting.fineness = 4e-3 / std::pow(2.0, k);
      const double value = other ? 180 - turned[k] : turned[k];
      result.answers["turned_deg"] = {true, value, value - 60, value + 60, value, 0, 0};
      ladder.settings.push_back(result);
    }
    study.series.push_back(ladder);
  }
  judge(study, {});
  for (const SeriesResult& series : study.series)
    for (const SettingResult& setting : series.settings) {
      const Answer& answer = setting.answers.at("turned_deg");
      EXPECT_LE(answer.uncertainty, std::max(answer.value, 180 - answer.value)) << series.series.name;
    }
}

/// A direction straight back lies on both sides of 180 degrees; the study of it may not tell a whole turn of error.
TEST(Judge, TakesDirectionsOnTheCircle) {
  Study study;
  SeriesResult ladder;
  ladder.series.steps = true;
  const double direction[] = {179.6, -179.9, 179.95, -179.99, 179.99};
  for (int k = 0; k < 5; ++k) {
    SettingResult result;
    result.setting.fineness = 4e-3 / std::pow(2.0, k);
    Answer answer{true, direction[k], direction[k] - 0.02, direction[k] + 0.02, direction[k], 0, 0};
    result.answers["pdof_deg car"] = answer;
    ladder.settings.push_back(result);
  }
  study.series.push_back(ladder);
  judge(study, {});
  ASSERT_NE(study.find("pdof_deg car"), nullptr);
  for (const SettingResult& setting : study.series.front().settings) {
    const Answer& answer = setting.answers.at("pdof_deg car");
    EXPECT_LT(std::abs(answer.error), 0.5) << setting.setting.fineness;
    EXPECT_LT(answer.high - answer.low, 0.05);
    EXPECT_NEAR(answer.middle, answer.value, 1e-9);
  }
}

}  // namespace
}  // namespace cli::study
