// `crashreel sample` from outside, and the mathematics below it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "../program.h"
#include "cli/inference/crew.h"
#include "cli/inference/sample.h"
#include "cli/inference/sequence.h"

namespace cli_tests {
namespace {

using namespace cli::inference;
using ::testing::HasSubstr;

const std::string kScene = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/gallery/sample_puck.toml";

Result sample(const Folder& folder, const std::string& out, const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"sample", kScene, "-o", out, "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run(folder, arguments);
}

TEST(Sample, SharesOfTheVarianceAreThoseOfTheFormula) {
  const Folder folder;
  const Result result = sample(folder, "out", {"-n", "256"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto answer = nlohmann::json::parse(contents(folder / "out/sample.json"));
  const auto& travel = answer["outputs"]["travel_m"];
  // d = v^2 / (2 mu g), v uniform 26..34 mph, mu normal 0.6, 0.04 and independent: E d = E v^2 E 1/mu / (2 g), and so on. With
  // r = 0.04/0.6, E 1/mu = (1 + r^2 + 3 r^4)/0.6 and E 1/mu^2 = (1 + 3 r^2 + 15 r^4)/0.36 to 1e-4
  const double mph = 0.44704, a = 26 * mph, b = 34 * mph, r = 0.04 / 0.6;
  const double v2 = (b * b * b - a * a * a) / (3 * (b - a)), v4 = (std::pow(b, 5) - std::pow(a, 5)) / (5 * (b - a));
  const double m1 = (1 + r * r + 3 * std::pow(r, 4)) / 0.6, m2 = (1 + 3 * r * r + 15 * std::pow(r, 4)) / 0.36, k = 1 / (2 * 9.81);
  const double mean = k * v2 * m1, variance = k * k * v4 * m2 - mean * mean;
  const double of_speed = k * k * m1 * m1 * (v4 - v2 * v2) / variance, of_friction = k * k * v2 * v2 * (m2 - m1 * m1) / variance;
  // 256 scrambled points: the mean to a thousandth of the deviation's size, shares to a hundredth
  EXPECT_NEAR(travel["mean"].get<double>(), mean, 0.02);
  EXPECT_NEAR(travel["sd"].get<double>(), std::sqrt(variance), 0.03);
  EXPECT_NEAR(travel["sensitivity"]["variables.speed"]["first"]["value"].get<double>(), of_speed, 0.01);
  EXPECT_NEAR(travel["sensitivity"]["variables.friction"]["first"]["value"].get<double>(), of_friction, 0.01);
  EXPECT_NEAR(travel["sensitivity"]["variables.friction"]["total"]["value"].get<double>(), 1 - of_speed, 0.01);
  EXPECT_LT(travel["scatter"]["value"].get<double>(), 1e-3);
}

TEST(Sample, TheNumbersDoNotHangOnTheNumberOfProcesses) {
  const Folder folder;
  ASSERT_EQ(sample(folder, "one", {"-n", "16", "--jobs", "1"}).code, 0);
  ASSERT_EQ(sample(folder, "three", {"-n", "16", "--jobs", "3"}).code, 0);
  EXPECT_EQ(contents(folder / "one/runs.csv"), contents(folder / "three/runs.csv"));
  EXPECT_EQ(contents(folder / "one/sample.json"), contents(folder / "three/sample.json"));
  ASSERT_EQ(sample(folder, "other", {"-n", "16", "--seed", "2"}).code, 0);
  EXPECT_NE(contents(folder / "one/runs.csv"), contents(folder / "other/runs.csv"));
}

TEST(Sample, GoesOnWhereItStood) {
  const Folder folder;
  ASSERT_EQ(sample(folder, "whole", {"-n", "16"}).code, 0);
  ASSERT_EQ(sample(folder, "part", {"-n", "16"}).code, 0);
  // a job killed in the middle of a line
  for (const auto& entry : std::filesystem::directory_iterator(folder / "part/runs")) {
    std::string text = contents(entry.path());
    std::ofstream(entry.path(), std::ios::binary) << text.substr(0, text.size() / 2 + 7);
  }
  EXPECT_EQ(sample(folder, "part", {"-n", "16"}).code, 2);  // results exist
  ASSERT_EQ(sample(folder, "part", {"-n", "16", "--overwrite"}).code, 0);
  EXPECT_EQ(contents(folder / "part/runs.csv"), contents(folder / "whole/runs.csv"));
}

TEST(Sample, ARunThatFailsIsARowWithItsReason) {
  const Folder folder;
  folder.write("ball.toml", ball_with("mass = \"2 kg\"", "mass = \"mass\"") +
                                "[variables]\nmass = \"1 kg\"\n[[uncertain]]\nkey = \"variables.mass\"\nuniform = \"-1 3 kg\"\n");
  const Result result = run(folder, {"sample", "ball.toml", "-o", "out", "-n", "16", "--quiet"});
  ASSERT_EQ(result.code, 0) << result.err;
  const std::string csv = contents(folder / "out/runs.csv");
  EXPECT_THAT(csv, HasSubstr("must be greater than 0 kg"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 17);
  EXPECT_THAT(result.out, HasSubstr("4 of 16 runs gave no answer"));  // a quarter of the range, evenly filled
}

TEST(Sample, AGridRunsEveryValue) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result = run(folder, {"sample", "ball.toml", "-o", "out", "--grid", "body.ball.velocity=1 0 0 m/s,2 0 0 m/s",
                                     "--grid", "body.ball.friction=0.1,0.2,0.3", "--quiet"});
  ASSERT_EQ(result.code, 0) << result.err;
  const std::string csv = contents(folder / "out/runs.csv");
  EXPECT_THAT(csv, testing::StartsWith("run,status,in.body.ball.velocity,in.body.ball.friction,out."));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
}

TEST(Sample, AGridIsATableAndNoProbability) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result =
      run(folder, {"sample", "ball.toml", "-o", "out", "--grid", "body.ball.velocity=1 0 0 m/s,2 0 0 m/s,3 0 0 m/s", "--quiet"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.out.find("5 %"), std::string::npos) << result.out;
  EXPECT_THAT(result.out, HasSubstr("Over the values given the travel lies between "));
  // a row a run in the order given, the measure of the charts behind the value
  EXPECT_THAT(result.out, testing::ContainsRegex("\n  body\\.ball\\.velocity  travel \\[m\\]"));
  const std::size_t one = result.out.find("\n           1 0 0 m/s  "), three = result.out.find("\n           3 0 0 m/s  ");
  ASSERT_NE(one, std::string::npos) << result.out;
  ASSERT_NE(three, std::string::npos);
  EXPECT_LT(one, three);
  // a ball in the air for 0.4 s less what friction takes on the ground: between nothing and the way at full speed
  const double way = std::stod(result.out.substr(three + 23));
  EXPECT_GT(way, 0.5);
  EXPECT_LT(way, 1.2);
}

TEST(Sample, TellsTheMeasureOfItsChartsFirstAndWhatWasChanged) {
  const Folder folder;
  const std::string scene = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/sedan_pedestrian_fit.toml";
  const Result result = run(folder, {"sample", scene, "-o", "out", "-n", "2", "--quiet", "--set", "simulation.duration=0.5 s"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, testing::StartsWith("How fast was the sedan? Assumed evidence for a struck pedestrian "
                                              "[changed: simulation.duration=0.5 s]\n"));
  // percentiles stand below the sentences: the main measure, then what a screen of results shows
  const std::size_t main = result.out.find("\n  throw distance [m] "), first = result.out.find(" runs   5 %: ");
  ASSERT_NE(main, std::string::npos) << result.out;
  EXPECT_EQ(result.out.find('\n', main + 1), result.out.find('\n', first)) << "in the first row";
  EXPECT_THAT(result.out, HasSubstr("\n  head impact speed [m/s] "));
  EXPECT_EQ(result.out.find("peak acceleration"), std::string::npos);
  EXPECT_THAT(contents(folder / "out/sample.json"), HasSubstr("peak_acceleration_mps2 pedestrian/head"));
}

TEST(Sample, RefusesWhatCannotBe) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  EXPECT_THAT(sample(folder, "out", {"-n", "0"}).err, HasSubstr("-n"));
  EXPECT_EQ(sample(folder, "out", {"-n", "0"}).code, 2);
  const Result nothing = run(folder, {"sample", "ball.toml", "-o", "out"});
  EXPECT_EQ(nothing.code, 2);
  EXPECT_THAT(nothing.err, HasSubstr("nothing is uncertain; add [[uncertain]]"));
  EXPECT_EQ(sample(folder, "out", {"--grid", "speed"}).code, 2);
  // not one run of the grid could begin: told before the work, and no folder left behind
  const Result bare = run(folder, {"sample", "ball.toml", "-o", "none", "--grid", "body.ball.mass=1,2"});
  EXPECT_EQ(bare.code, 2);
  EXPECT_THAT(bare.err, HasSubstr("crashreel: --grid body.ball.mass=1: body.ball.mass = 1 needs a unit: write \"1 kg\""));
  EXPECT_FALSE(std::filesystem::exists(folder / "none"));
}

TEST(ScrambledPoints, FillEveryAxisAndItsPairsEvenly) {
  for (const std::uint64_t seed : {1u, 2u, 77u}) {
    const auto points = scrambled_points(3, 0, 256, seed);
    // a net: of 256 points one in each of 256 slices of every axis, and one in each cell of 16 x 16 of the first two
    std::vector<int> cells(256, 0);
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<int> slices(256, 0);
      for (const auto& p : points) ++slices[static_cast<std::size_t>(p[axis] * 256)];
      EXPECT_THAT(slices, testing::Each(1)) << "axis " << axis << ", seed " << seed;
    }
    for (const auto& p : points) ++cells[static_cast<std::size_t>(p[0] * 16) * 16 + static_cast<std::size_t>(p[1] * 16)];
    EXPECT_THAT(cells, testing::Each(1)) << "seed " << seed;
  }
  const auto whole = scrambled_points(2, 0, 10, 5), part = scrambled_points(2, 6, 4, 5);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(part[i], whole[i + 6]);
}

TEST(Percentiles, HoldTheTruthAsOftenAsTheySay) {
  // 400 samples of 60 numbers: the 95 % range of the 75th percentile holds it at least 95 times in 100; three deviations fewer: 92
  // %
  int inside = 0;
  for (std::uint64_t s = 0; s < 400; ++s) {
    std::vector<double> sample;
    for (std::uint64_t i = 0; i < 60; ++i) sample.push_back(static_cast<double>(mixed(mixed(s) + i) >> 11) * 0x1p-53);
    const Percentile p = percentile_of(sample, 0.75);
    inside += p.low <= 0.75 && 0.75 <= p.high;
  }
  EXPECT_GE(inside, 368);
}

TEST(Prior, QuantilesOfEverySpread) {
  scenes::Uncertain u;
  u.spread = scenes::Spread::triangular;
  u.numbers = {0, 1, 4};
  EXPECT_DOUBLE_EQ(quantile(u, 0.25), 1);  // the area left of the top is a quarter
  u.spread = scenes::Spread::table;
  u.numbers = {0, 1, 3};
  u.weights = {0, 2, 0};
  EXPECT_NEAR(quantile(u, 1.0 / 3), 1, 1e-12);
  EXPECT_NEAR(quantile(u, 0.0), 0, 1e-12);
  EXPECT_NEAR(quantile(u, 1.0), 3, 1e-6);
  u.spread = scenes::Spread::log_normal;
  u.numbers = {2, 1.5};
  EXPECT_NEAR(quantile(u, normal_share(1)), 3, 1e-12);
  u.spread = scenes::Spread::normal;
  u.numbers = {10, 2};
  u.lower = 10;
  EXPECT_NEAR(quantile(u, 0.0), 10, 1e-6);
  EXPECT_NEAR(quantile(u, 0.5), 10 + 2 * 0.6744897501960817, 1e-9);  // the upper quartile of the whole
}

TEST(Crew, ADeadProcessTakesOnlyItsPiece) {
  std::vector<std::string> lines(20), deaths(20);
  run_crew(
      20, 3,
      [](std::size_t k) {
        if (k == 7) std::abort();
        return std::to_string(k * k) + "\n";
      },
      [&](std::size_t k, const std::string& line, const std::string& death) {
        lines[k] = line;
        deaths[k] = death;
      });
  for (std::size_t k = 0; k < 20; ++k) EXPECT_EQ(lines[k], k == 7 ? "" : std::to_string(k * k) + "\n");
  EXPECT_THAT(deaths[7], HasSubstr("signal 6"));
}

}  // namespace
}  // namespace cli_tests
