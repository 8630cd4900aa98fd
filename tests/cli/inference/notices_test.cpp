// Runs that ended too early and runs with a warning are counted wherever the answers of many are told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "../program.h"
#include "cli/output/notices.h"

namespace cli_tests {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A braking car throws a person; in 1.5 s neither comes to rest, in 6 s both do.
const std::string kThrow = R"(title = "Throw"
[simulation]
duration = "1.5 s"
[variables]
speed = "40 km/h"
ahead = "0.5 m"
[[vehicle]]
name = "car"
model = "sedan"
front = ["-ahead", "0 m"]
speed = "speed"
[vehicle.brake]
from = "0 s"
[[person]]
name = "p"
position = "0 0 m"
heading = "90 deg"
[[uncertain]]
key = "variables.speed"
uniform = "38 42 km/h"
)";

TEST(Sample, TellsOfThrowsThatAreNotOver) {
  const Folder folder;
  folder.write("throw.toml", kThrow);
  const Result result = run(folder, {"sample", "throw.toml", "-o", "out", "-n", "4", "--quiet"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("  4 of 4 runs: still moving at the end, "));
  EXPECT_THAT(result.out, HasSubstr("throw_distance_m so far only. Give a longer simulation.duration.\n"));
  const auto json = nlohmann::json::parse(contents(folder / "out/sample.json"));
  EXPECT_EQ(json["unfinished"]["runs"], 4);
  EXPECT_THAT(json["unfinished"]["measures"].dump(), HasSubstr("\"throw_distance_m\""));
  EXPECT_THAT(contents(folder / "out/runs.csv"), HasSubstr("still moving at the end: "));
  EXPECT_THAT(contents(folder / "out/sample.svg").size(), testing::Gt(1000u));
  EXPECT_FALSE(std::filesystem::exists(folder / "out/rest_cloud.svg")) << "nobody and nothing has come to rest";

  const Result longer =
      run(folder, {"sample", "throw.toml", "-o", "longer", "-n", "2", "--quiet", "--set", "simulation.duration=8 s"});
  ASSERT_EQ(longer.code, 0) << longer.err;
  EXPECT_THAT(longer.out, Not(HasSubstr("still moving")));
  EXPECT_TRUE(std::filesystem::exists(folder / "longer/rest_cloud.svg"));
}

TEST(Eval, TellsOfThrowsThatAreNotOverAndTakesMeasuresBetweenCommas) {
  const Folder folder;
  folder.write("throw.toml", kThrow);
  folder.write("rows.csv", "variables.speed\n40 km/h\n");
  const Result result =
      run(folder, {"eval", "throw.toml", "rows.csv", "results.csv", "--measure", "throw_distance_m,head_impact_s"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("crashreel: warning: 1 of 1 runs: still moving at the end, "));
  const std::string text = contents(folder / "results.csv");
  EXPECT_THAT(text, testing::StartsWith("row,status,throw_distance_m,head_impact_s,notes\n1,ok,"));
  EXPECT_THAT(text, HasSubstr("still moving at the end: "));
}

TEST(Sample, CountsTheWarningsOfItsRuns) {
  const Folder folder;
  folder.write("throw.toml", kThrow);
  const Result result = run(folder, {"sample", "throw.toml", "-o", "out", "--grid", "variables.ahead=-0.5,0.5 m", "--quiet",
                                     "--set", "simulation.duration=0.2 s"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("1 of 2 runs carry a warning"));
  const auto json = nlohmann::json::parse(contents(folder / "out/sample.json"));
  EXPECT_THAT(json["warnings"].dump(), HasSubstr(R"({"runs":1,"warning":"p stands inside car at the start"})"));
  EXPECT_THAT(contents(folder / "out/runs.csv"), HasSubstr("\n1,ok,"));
  EXPECT_THAT(contents(folder / "out/runs.csv"), HasSubstr("warning: p stands inside car at the start"));
}

TEST(Eval, CountsTheWarningsOfItsRuns) {
  const Folder folder;
  folder.write("throw.toml", kThrow);
  folder.write("rows.csv", "variables.ahead\n-0.5 m\n0.5 m\n");
  const Result result = run(folder, {"eval", "throw.toml", "rows.csv", "results.csv", "--measure", "throw_distance_m", "--set",
                                     "simulation.duration=0.2 s"});
  EXPECT_THAT(result.err, HasSubstr("crashreel: warning: 1 of 2 runs carry a warning"));
  EXPECT_THAT(contents(folder / "results.csv"), HasSubstr("p stands inside car at the start"));
}

TEST(Notices, SayHowManyOfHowMany) {
  cli::Notices notices;
  notices.add({{"throw_distance_m"}, {}});
  notices.add({{}, {"odd"}});
  notices.add({{}, {"odd", "other"}});
  EXPECT_THAT(cli::in_words(notices),
              testing::ElementsAre("1 of 3 runs: still moving at the end, throw_distance_m so far only. Give a longer "
                                   "simulation.duration.",
                                   "2 of 3 runs carry a warning, the commonest in 2: odd."));
  EXPECT_THAT(cli::in_words({}), testing::IsEmpty());
}

TEST(Notices, CountWarningsThatDifferByTheirNumbersAsOne) {
  cli::Notices notices;
  notices.add({{}, {"the neck of p1 bears 10.1 kN at 1279 ms"}});
  notices.add({{}, {"the neck of p1 bears 9 kN at 980 ms", "the neck of p1 bears 8 kN at 1100 ms"}});
  notices.add({{}, {"the neck of p2 bears 9 kN at 980 ms"}});
  notices.add({{}, {}});
  EXPECT_THAT(cli::in_words(notices),
              testing::ElementsAre("3 of 4 runs carry a warning, the commonest in 2, here with the numbers of one run: the neck of "
                                   "p1 bears 10.1 kN at 1279 ms."));
}

}  // namespace
}  // namespace cli_tests
