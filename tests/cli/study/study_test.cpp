// `crashreel study` from outside: files, columns, errors against closed forms, and that finished runs are not run again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "../program.h"
#include "cli/study/output.h"
#include "cli/study/page.h"
#include "cli/study/quantities.h"
#include "engine/simulate.h"
#include "scenes/scene.h"

namespace cli_tests {
namespace {

const std::string kScenes = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/";

/// A short run: the slide of the puck, few members.
Result study_puck(const Folder& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"study", kScenes + "gallery/puck_slide.toml", "-o", "out", "--ensemble", "1", "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run(folder, arguments);
}

/// Sentences read aloud in a court: a figure with its unit is one word.
void expect_short_sentences(const nlohmann::json& findings) {
  const std::regex figure("(\u00b1 )?-?[0-9][0-9.e-]*( ((\u00b5|m)?m/s|(\u00b5|n|m)?m|m?s|km/h|deg|g|J|N)\\b)?"), end("[.] ");
  ASSERT_GE(findings.size(), 4u);
  for (const std::string finding : findings) {
    const std::string text = std::regex_replace(finding, figure, "1");
    for (std::sregex_token_iterator sentence(text.begin(), text.end(), end, -1), last; sentence != last; ++sentence) {
      std::istringstream words(*sentence);
      EXPECT_LE(std::distance(std::istream_iterator<std::string>(words), {}), 15) << finding;
    }
  }
}

TEST(Study, WritesColumnsAndErrorsAgainstTheClosedFormAndUsesFinishedRunsForATarget) {
  const Folder folder;
  const Result result = study_puck(folder);
  ASSERT_EQ(result.code, 0) << result.err;
  const std::string csv = contents(folder / "out/study.csv");
  EXPECT_TRUE(csv.starts_with("series,setting,step_s,quantity,value,error,error_kind,wall_s,steps_per_s,order,uncertainty"));
  const auto written = nlohmann::json::parse(contents(folder / "out/study.json"));
  EXPECT_EQ(written["schema"], 1);
  EXPECT_EQ(written["main_quantity"], "travel_m");
  expect_short_sentences(written["findings"]);
  const auto& ladder = written["series"][0]["settings"];
  ASSERT_EQ(ladder.size(), 7u);  // six halvings
  for (const auto& setting : ladder) {
    // Coulomb friction stops the puck within the step: the last step at mu g h takes the distance to within v h
    const double step = setting["step_s"];
    EXPECT_LT(std::abs(setting["answers"]["travel_m"]["error"].get<double>()), 0.6 * 9.81 * step);
    EXPECT_GT(setting["wall_s"].get<double>(), 0);
  }
  // a second opinion takes no step of the scene's own ladder
  int others = 0;
  for (const auto& series : written["series"]) {
    if (series["series"] == "rk4") {
      for (const auto& other : series["settings"]) {
        ++others;
        for (const auto& own : ladder)
          EXPECT_GT(std::abs(std::log(other["step_s"].get<double>() / own["step_s"].get<double>())), 0.2);
      }
    }
  }
  EXPECT_GT(others, 0);
  EXPECT_THAT(result.out, ::testing::ContainsRegex("travel: [0-9.]+ m?s of computing buys"));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("travel: Largest share first: [a-z ]+ .+ [0-9.]+ "));

  EXPECT_EQ(study_puck(folder).code, 2);  // results exist
  const Result again = study_puck(folder, {"--overwrite", "--target", "travel=1cm"});
  ASSERT_EQ(again.code, 0) << again.err;
  // wall times are measured: equal ones mean that nothing ran again
  EXPECT_EQ(contents(folder / "out/study.csv"), csv);
  // the cheapest setting that reaches a target is named. Which it is is measured: settings of equal work change places
  nlohmann::json cheapest, own;
  for (const auto& series : written["series"]) {
    if (series["varies"] == "interval" || series["meaning"].get<std::string>().starts_with("another law")) continue;
    for (const auto& setting : series["settings"]) {
      if (setting["own"]) own = setting;
      if (setting["answers"]["travel_m"]["uncertainty"] <= 0.01 && (cheapest.is_null() || setting["wall_s"] < cheapest["wall_s"]))
        cheapest = setting;
    }
  }
  EXPECT_NE(again.out.find(": " + cheapest["setting"].get<std::string>() + ", "), std::string::npos) << again.out;
  EXPECT_LT(cheapest["wall_s"], 0.6 * own["wall_s"].get<double>());  // four times the step
  EXPECT_THAT(again.out, ::testing::ContainsRegex("\\[simulation\\]\nstep = \"[0-9.]+ ms\"\n"));
  EXPECT_EQ(again.out.find("record_interval"), std::string::npos) << again.out;
}

TEST(Study, LeavesOutEachEffectInTurn) {
  const Folder folder;
  const Result result = study_puck(folder, {"--effects"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(
      contents(folder / "out/effects.csv").starts_with("effect,quantity,value,without,change,spread,wall_s,saved_s,failure"));
  const auto written = nlohmann::json::parse(contents(folder / "out/effects.json"));
  bool gravity = false;
  for (const auto& effect : written["effects"]) {
    if (effect["effect"] != "gravity") continue;
    gravity = true;
    // without weight there is no friction: it slides on for the 2.6 s of the scene
    EXPECT_NEAR(effect["change"]["travel_m"].get<double>(), 13.4112 * 2.6 - 15.2786515, 1e-3);
  }
  EXPECT_TRUE(gravity);
}

TEST(Study, TellsWhatAPictureCosts) {
  const Folder folder;
  const Result result = study_puck(folder, {"--picture", "--set", "output.width=320", "--set", "output.height=180"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto written = nlohmann::json::parse(contents(folder / "out/picture.json"));
  std::map<std::string, std::vector<double>> errors, likeness;  // by series, with rising effort
  for (const auto& setting : written["settings"]) {
    EXPECT_GT(setting["frame_ms"].get<double>(), 0);
    errors[setting["series"]].push_back(setting["rms_255"]);
    likeness[setting["series"]].push_back(setting["ssim"]);
  }
  for (const char* series : {"quality", "samples"}) {
    EXPECT_THAT(errors[series], ::testing::SizeIs(::testing::Ge(3)));
    EXPECT_TRUE(std::is_sorted(errors[series].rbegin(), errors[series].rend())) << series;
  }
  // standard: a reference of other things than this picture shows has had two thirds
  EXPECT_GT(likeness["quality"][1], 0.95);
}

TEST(Study, ForgetsAFormulaThatIsNoLongerThatOfTheScene) {
  const Folder folder;
  ASSERT_EQ(study_puck(folder, {"--set", "body.puck.friction=0.5"}).code, 0);
  const auto written = nlohmann::json::parse(contents(folder / "out/study.json"));
  for (const auto& quantity : written["quantities"]) EXPECT_NE(quantity["error_kind"], "closed_form");
}

/// The run ends when the car has come to rest and the person has not: whose rest it is stands in the name as in a longer run.
TEST(Study, AMeasureHasOneNameInEveryRun) {
  const scenes::Scene scene = scenes::load(kScenes + "cases/sedan_pedestrian_40kmh.toml", {"simulation.duration=2.3 s"});
  std::vector<std::string> names;
  for (const auto& q : cli::study::quantities_of(scene.model, engine::simulate(scene.model))) names.push_back(q.name);
  EXPECT_THAT(names, ::testing::Contains("rest_s sedan"));
  EXPECT_THAT(names, ::testing::Not(::testing::Contains(::testing::AnyOf("rest_s", "rest_s pedestrian"))));
  EXPECT_THAT(names, ::testing::Contains("throw_distance_m")) << "nobody else could have one";
}

/// The speed falls to both sides of the scene's own value: the ends alone would say that it does not matter.
TEST(Study, AnInputCountsWhatTheSceneItselfAnswers) {
  const Folder folder;
  folder.write("turn.toml", R"toml(title = "Turn"
[simulation]
duration = "1.5 s"
[variables]
x = "0 m/s"
[[body]]
name = "puck"
mass = "2 kg"
axes = "0.1 0.1 0.1 m"
exponent = 8
position = "0 0 0.1 m"
velocity = ["5 m/s - sqrt(x * x)", "0 m/s", "0 m/s"]
friction = 0.5
)toml");
  const auto study = [&](const std::string& range) {
    return run(folder,
               {"study", "turn.toml", "-o", "out", "--ensemble", "0", "--quiet", "--overwrite", "--input", "variables.x=" + range});
  };
  const Result result = study("-1 m/s..1 m/s");
  ASSERT_EQ(result.code, 0) << result.err;
  const auto input = nlohmann::json::parse(contents(folder / "out/study.json"))["inputs"][0];
  // v^2 / (2 mu g) of 5 and of 4 m/s; a block that tips a little as it brakes is off by a few hundredths
  EXPECT_NEAR(input["half_width"]["travel_m"].get<double>(), (25.0 - 16) / (2 * 0.5 * 9.81) / 2, 0.05);
  EXPECT_THAT(input["not_monotonic"].dump(), ::testing::HasSubstr("\"travel_m\""));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("travel_m +0\\.4[0-9]+  at least: not monotonic"));

  EXPECT_THAT(study("1 m/s..-1 m/s").err, ::testing::HasSubstr("the range falls; write the lower end first"));
  EXPECT_THAT(study("1 m/s..3.6 km/h").err, ::testing::HasSubstr("the range is a single value"));
  const Result outside = study("1 m/s..7.2 km/h");
  EXPECT_EQ(outside.code, 2);
  EXPECT_EQ(outside.err,
            "crashreel: --input variables.x=1 m/s..7.2 km/h: the range does not hold the scene's own value, 0 m/s; "
            "widen it, or set another value with --set\n");
}

/// A throw that the end of the run cuts off is marked, and a study counts it.
TEST(Study, TellsOfThrowsThatAreNotOver) {
  const scenes::Scene scene = scenes::load(kScenes + "cases/sedan_pedestrian_40kmh.toml", {"simulation.duration=1.2 s"});
  bool found = false;
  for (const auto& q : cli::study::quantities_of(scene.model, engine::simulate(scene.model))) {
    found = found || q.name == "throw_distance_m";
    if (q.name == "throw_distance_m" || q.name == "head_impact_s") {
      EXPECT_EQ(q.so_far, q.name == "throw_distance_m");
    }
  }
  EXPECT_TRUE(found);
  cli::study::Study study;
  study.series.push_back({});
  study.series.front().settings.push_back({});
  study.series.front().settings.front().setting.own = true;
  study.notices.add({{"throw_distance_m"}, {}});
  EXPECT_THAT(cli::study::study_text(scene, study), ::testing::HasSubstr("  1 of 1 runs: still moving at the end, "));
  EXPECT_EQ(cli::study::study_json(scene, study)["unfinished"]["runs"], 1);
}

TEST(StudyPage, CallsARangeOneAndGivesNanometresOfANoughtNoFullBar) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  cli::study::Study study;
  study.series.push_back({});
  cli::study::SeriesResult& ladder = study.series.front();
  ladder.series.varies = "step";
  const double travel[] = {0, 4e-8, -2e-8, 3e-8, 1e-8};
  for (int k = 0; k < 5; ++k) {
    cli::study::SettingResult result;
    result.setting.label = "step";
    result.setting.fineness = 4e-3 / std::pow(2.0, k);
    result.setting.own = k == 2;
    result.answers["travel_m"] = {true, travel[k], travel[k], travel[k], travel[k], 0, 0};
    ladder.settings.push_back(result);
  }
  cli::study::judge(study, {});
  const render::charts::Page page = cli::study::page_of(scenes::load(folder / "ball.toml"), study);
  ASSERT_EQ(page.bars.rows.size(), 1u);
  EXPECT_LT(page.bars.rows[0].parts[0], 1e-3);
  EXPECT_THAT(page.table.head, ::testing::Contains("range \u00b1"));
}

TEST(Study, RefusesAnInputThatIsNoRange) {
  const Folder folder;
  const Result result = study_puck(folder, {"--input", "body.puck.friction=0.5"});
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("PATH=LOW..HIGH"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace cli_tests
