// `crashreel fit` from outside, against answers in closed form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "../program.h"

namespace cli_tests {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kMph = 0.44704;
const std::string kGallery = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/gallery/";

Result fit(const Folder& folder, const std::string& scene, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"fit", scene, "-o", "out", "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run(folder, arguments);
}

json fitted(const Folder& folder) {
  return json::parse(contents(folder / "out/fit.json"));
}

/// Mean and deviation of exp(-(v^2/(2 mu g) - d)^2 / (2 t^2)) for v between two speeds, by the trapezium rule.
std::pair<double, double> exact_posterior(double d, double t, double mu, double low, double high) {
  double sum = 0, first = 0, second = 0;
  constexpr int kSteps = 200'000;
  for (int i = 0; i <= kSteps; ++i) {
    const double v = low + (high - low) * i / kSteps, off = (v * v / (2 * mu * 9.81) - d) / t, w = std::exp(-0.5 * off * off);
    sum += w;
    first += w * v;
    second += w * v * v;
  }
  return {first / sum, std::sqrt(second / sum - first * first / (sum * sum))};
}

TEST(Fit, TheSpeedOfASlideIsThatOfTheFormula) {
  const Folder folder;
  const Result result = fit(folder, kGallery + "fit_puck.toml", {"-n", "1000"});
  ASSERT_EQ(result.code, 0) << result.err;
  const json all = fitted(folder);
  const json& speed = all["inputs"]["variables.speed"];
  const auto [mean, sd] = exact_posterior(36.378, 0.5, 0.7, 30 * kMph, 70 * kMph);
  EXPECT_TRUE(all["single_number"].get<bool>()) << all["reasons"].dump();
  EXPECT_FALSE(all["contradiction"].get<bool>());
  EXPECT_NEAR(speed["mean"].get<double>(), 50 * kMph, 0.1 * kMph);
  EXPECT_NEAR(speed["mean"].get<double>(), mean, 0.02 * sd + 0.001 * mean);  // 0.02 sd of 200 effective runs, evenly filled
  EXPECT_NEAR(speed["sd"].get<double>(), sd, 0.02 * sd);
  EXPECT_NEAR(speed["p97_5"].get<double>() - speed["p2_5"].get<double>(), 3.92 * sd, 0.12 * sd);
  EXPECT_GE(all["effective_samples"].get<double>(), 200);
  EXPECT_THAT(result.out, HasSubstr("variables.speed 49.3 to 50.7 mph (95 %)"));
}

TEST(Fit, TellsWhichPartOfTheJobRuns) {
  const Folder folder;
  const Result result = run(folder, {"fit", kGallery + "fit_puck.toml", "-o", "out", "-n", "100", "--progress", "always",
                                     "--but-for", "variables.speed=45 mph"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("fit first half 100 %  50 of 50 runs"));
  EXPECT_THAT(result.err, HasSubstr("fit round 1 of 4 100 %"));
}

TEST(Fit, TwoAnswersAreBothShownAndNoneBetween) {
  const Folder folder;
  ASSERT_EQ(fit(folder, kGallery + "fit_two_ways.toml", {"-n", "800"}).code, 0);
  const json all = fitted(folder);
  EXPECT_FALSE(all["single_number"].get<bool>());
  const json& speed = all["inputs"]["variables.speed"];
  EXPECT_TRUE(speed["mean"].is_null());
  ASSERT_EQ(speed["modes"].size(), 2u);
  const double v = std::sqrt(2 * 0.6 * 9.81 * 15);  // 13.29 m/s, give or take 0.22
  for (const int sign : {-1, 1}) {
    const json& mode = speed["modes"][sign < 0 ? 0 : 1];
    EXPECT_NEAR(mode["peak"].get<double>(), sign * v, 0.2);
    EXPECT_NEAR(mode["to"].get<double>() - mode["from"].get<double>(), 3.92 * 0.5 * 0.6 * 9.81 / v, 0.2);
    EXPECT_NEAR(mode["share"].get<double>(), 0.5, 0.1);
  }
}

TEST(Fit, EvidenceThatContradictsItselfIsToldAndGivesNoNumber) {
  const Folder folder;
  const Result result = fit(folder, kGallery + "fit_contradiction.toml", {"-n", "400"});
  ASSERT_EQ(result.code, 0) << result.err;
  const json all = fitted(folder);
  EXPECT_TRUE(all["contradiction"].get<bool>());
  EXPECT_FALSE(all["single_number"].get<bool>());
  EXPECT_TRUE(all["inputs"]["variables.speed"]["mean"].is_null());
  for (const json& e : all["evidence"]) EXPECT_LT(e["p_value"].get<double>(), 0.005) << e["name"];
  EXPECT_THAT(result.out, HasSubstr("contradict each other or the model"));
}

TEST(Fit, AnAnswerBeyondTheRangeIsNoAnswer) {
  const Folder folder;
  ASSERT_EQ(fit(folder, kGallery + "fit_puck.toml", {"-n", "400", "--set", "uncertain.0.uniform=\"30 49.8 mph\""}).code, 0);
  const json all = fitted(folder);
  EXPECT_FALSE(all["single_number"].get<bool>());
  EXPECT_THAT(all["reasons"].dump(), HasSubstr("upper end of what was held possible"));
}

TEST(Fit, TheNumbersDoNotHangOnTheNumberOfProcesses) {
  const Folder folder;
  ASSERT_EQ(fit(folder, kGallery + "fit_puck.toml", {"-n", "64", "--jobs", "1"}).code, 0);
  const std::string one = contents(folder / "out/posterior.csv");
  std::filesystem::remove_all(folder / "out");
  ASSERT_EQ(fit(folder, kGallery + "fit_puck.toml", {"-n", "64", "--jobs", "3"}).code, 0);
  EXPECT_EQ(contents(folder / "out/posterior.csv"), one);
  EXPECT_THAT(one, StartsWith("run,weight,status,in.variables.speed,out."));
}

TEST(Fit, TheBestRunIsASceneThatGivesItsMisfit) {
  const Folder folder;
  ASSERT_EQ(fit(folder, kGallery + "fit_puck.toml", {"-n", "64"}).code, 0);
  ASSERT_EQ(run(folder, {"simulate", "out/best.toml", "-o", "best", "--quiet"}).code, 0);
  const auto summary = json::parse(contents(folder / "best/summary.json"));
  const double off = std::abs(summary["metrics"]["travel_m"].get<double>() - 36.378) / 0.5;
  EXPECT_NEAR(off, fitted(folder)["best"]["misfit"].get<double>(), 1e-9);
}

TEST(Fit, ButForAsksTheSameRunsAgain) {
  const Folder folder;
  const Result result = fit(folder, kGallery + "fit_puck.toml", {"-n", "800", "--but-for", "body.puck.friction=0.35"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(fitted(folder)["but_for"][0]["met"], 0);  // a puck alone meets nobody
  // a run that the posterior draws many times is made once
  std::vector<std::string> lines;
  for (const auto& journal : std::filesystem::directory_iterator(folder / "out/runs")) {
    std::istringstream in(contents(journal.path()));
    for (std::string line; std::getline(in, line);) lines.push_back(line);
  }
  EXPECT_GT(lines.size(), 800u);
  EXPECT_EQ(std::set<std::string>(lines.begin(), lines.end()).size(), lines.size());
  EXPECT_EQ(fit(folder, kGallery + "fit_puck.toml", {"--but-for", "body.puck.frction=0.3", "--overwrite"}).code, 2);
}

TEST(Fit, AnswersNoButForFromAHandfulOfRuns) {
  const Folder folder;
  const Result result = fit(folder, kGallery + "fit_puck.toml", {"-n", "16", "--but-for", "body.puck.friction=0.35"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("With body.puck.friction=0.35: not answered, too few effective runs ("));
  EXPECT_THAT(result.out, testing::ContainsRegex("only [0-9]+ effective runs carry the answer, 200 are needed: give more runs, "
                                                 "-n [1-9][0-9]*00 should do"));
  EXPECT_THAT(fitted(folder)["but_for"][0]["unanswered"].get<std::string>(), StartsWith("too few effective runs"));
}

TEST(Fit, SaysWhatIsMissing) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  EXPECT_THAT(fit(folder, "ball.toml").err, HasSubstr("nothing is uncertain"));
  EXPECT_THAT(fit(folder, kGallery + "sample_puck.toml").err, HasSubstr("there is no evidence; add [[evidence]]"));
  const Result unknown = fit(folder, kGallery + "fit_puck.toml", {"-n", "16", "--set", "evidence.0.metric=travl"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean \"travel\"?"));
}

TEST(Fit, SaysWhatCannotBe) {
  const Folder folder;
  EXPECT_EQ(fit(folder, kGallery + "fit_puck.toml", {"-n", "0"}).err,
            "crashreel: -n is \"0\": must be a whole number in 2..1000000\n");
  // evidence that no run can meet: 300 m from at most 70 mph
  const Result far = fit(folder, kGallery + "fit_puck.toml", {"-n", "32", "--set", "evidence.0.value=\"300 m\""});
  EXPECT_EQ(far.code, 0);
  EXPECT_THAT(far.out, HasSubstr("No single number can be given: no run comes near the evidence \"slide\": the nearest is "));
  EXPECT_THAT(far.out,
              HasSubstr(" tolerances off. The evidence, its tolerance, the ranges of the inputs or the model is wrong.\n"));
}

TEST(Eval, AnswersDakota) {
  const Folder folder;
  folder.write(
      "params.in",
      "   1 variables\n   2.0e+01 variables.speed\n   1 functions\n   1 ASV_1:travel_m\n   1 derivative_variables\n   1 DVV_1\n");
  const Result result = run(folder, {"eval", kGallery + "fit_puck.toml", "params.in", "results.out"});
  ASSERT_EQ(result.code, 0) << result.err;
  const std::string text = contents(folder / "results.out");
  EXPECT_NEAR(std::stod(text), 400 / (2 * 0.7 * 9.81), 0.02);
  EXPECT_THAT(text, HasSubstr(" travel_m\n"));
}

TEST(Eval, TheResultsFileIsThereWhateverGoesWrong) {
  const Folder folder;
  const auto eval = [&](const std::string& scene, const std::string& parameters) {
    std::filesystem::remove(folder / "results.out");
    folder.write("params.in", parameters);
    const Result result = run(folder, {"eval", scene, "params.in", "results.out"});
    EXPECT_NE(result.code, 0) << parameters;
    EXPECT_THAT(contents(folder / "results.out"), StartsWith("fail\n")) << parameters;
    return contents(folder / "results.out");
  };
  const std::string puck = kGallery + "fit_puck.toml";
  EXPECT_THAT(eval(puck, "1 variables\n1 variables.sped\n"), HasSubstr("no variable"));
  EXPECT_THAT(eval(puck, "1 variables\n20 variables.speed\n1 functions\n1 ASV_1:hic15\n"), HasSubstr("no measure hic15"));
  EXPECT_THAT(eval(puck, "1 variables\n20 variables.speed\n1 functions\n2 ASV_1:travel_m\n"), HasSubstr("no derivatives"));
  EXPECT_THAT(eval(puck, "1 variables\n-1 body.puck.mass\n"), HasSubstr("must be greater than 0 kg"));
  EXPECT_THAT(eval("nowhere.toml", "1 variables\n20 variables.speed\n"), HasSubstr("there is no such file"));
  eval(puck, "");
}

TEST(Eval, ManyRowsInOneCallInTheirOrder) {
  const Folder folder;
  folder.write("rows.csv", "variables.speed,body.puck.friction\n10 m/s,0.5\n36 km/h,-1\n20,0.7\n");
  const Result result =
      run(folder, {"eval", kGallery + "fit_puck.toml", "rows.csv", "results.csv", "--measure", "travel_m", "--jobs", "2"});
  EXPECT_EQ(result.code, 4);  // one of them failed
  const std::string text = contents(folder / "results.csv");
  EXPECT_THAT(text, StartsWith("row,status,travel_m,notes\n1,ok,10.1"));
  EXPECT_THAT(text, HasSubstr("\n2,fail: refused: "));
  EXPECT_THAT(text, HasSubstr("\n3,ok,29.1"));
}

}  // namespace
}  // namespace cli_tests
