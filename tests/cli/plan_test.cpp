// The plan a user reads: every row says why, what it leaves out, and with --measure what it costs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.h"

using namespace cli_tests;
using testing::HasSubstr;
using Json = nlohmann::json;

namespace {

/// The whole text of every row, which a terminal gets in several lines.
Result plan_of_ball(const Folder& folder, std::vector<std::string> more = {}) {
  folder.write("ball.toml", kBall);
  more.insert(more.begin(), {"plan", "ball.toml", "--json"});
  return run(folder, more);
}

}  // namespace

TEST(Plan, NamesEveryEffectWithItsReason) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result = run(folder, {"plan", "ball.toml", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  std::map<std::string, bool> active;
  for (const Json& line : Json::parse(result.out)) {
    active[line.at("effect")] = line.at("active");
    EXPECT_FALSE(line.at("reason").get<std::string>().empty()) << line;
  }
  EXPECT_TRUE(active.at("gravity"));
  EXPECT_GT(active.size(), 3U);
}

/// rk4 takes springs of joints and yielding contacts into its stages. Where a scene has neither it is stepping to the last bit, and
/// that is what a summary tells.
TEST(Plan, TellsTheSchemeThatIsIntegratedWith) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const auto summary = [&](std::vector<std::string> set) {
    std::vector<std::string> words = {"simulate", "ball.toml", "-o", "out", "--overwrite", "--json"};
    for (const std::string& s : set) words.insert(words.end(), {"--set", s});
    const Result result = run(folder, words);
    EXPECT_EQ(result.code, 0) << result.err;
    return Json::parse(contents(folder / "out/summary.json"));
  };
  const auto hash = [](const Json& of) { return of.at("recording").at("hash").get<std::string>(); };
  const Json stepping = summary({}), rk4 = summary({"simulation.scheme=rk4"});
  EXPECT_EQ(hash(rk4), hash(stepping));
  EXPECT_EQ(rk4.at("settings").at("integrator"), "stepping");
  EXPECT_EQ(rk4.at("settings").at("scheme"), "rk4");
  EXPECT_EQ(rk4.at("settings").at("once_a_step"), Json::array({"contacts"}));
  EXPECT_TRUE(stepping.at("settings").at("once_a_step").empty());
  const std::string law = "simulation.contact_law=compliant";
  const Json yields = summary({law}), in_stages = summary({law, "simulation.scheme=rk4"});
  EXPECT_NE(hash(in_stages), hash(yields));
  EXPECT_EQ(in_stages.at("settings").at("integrator"), "rk4");

  const std::string told =
      "scheme rk4 is integrated as stepping, to the last bit: all it could take into its stages is solved once a "
      "step: contacts; contact_law = \"compliant\" would take the contacts";
  const std::vector<std::string> asked = {"ball.toml", "--set", "simulation.scheme=rk4"};
  std::vector<std::string> check = {"check"}, plan = {"plan"};
  for (auto* command : {&check, &plan}) command->insert(command->end(), asked.begin(), asked.end());
  EXPECT_THAT(run(folder, check).err, HasSubstr(told));
  EXPECT_THAT(run(folder, plan).out, HasSubstr("scheme rk4 is integrated as stepping"));
}

TEST(Plan, NamesTheCriterionOfEveryRow) {
  const Folder folder;
  const Result result = plan_of_ball(folder);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("9.81 m/s^2 on 1 body, 2 kg together"));
  EXPECT_THAT(result.out, HasSubstr("1 free body over the plane; the lowest point starts 0.2 m above it"));
  EXPECT_THAT(result.out, HasSubstr("no joints"));
  EXPECT_THAT(result.out, HasSubstr("no vehicle"));
}

TEST(Plan, TellsThatTheModelsInertiaGoesWithTheMass) {
  const Folder folder;
  folder.write("a.toml", "[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\nmass = \"1800 kg\"\n");
  const Result result = run(folder, {"plan", "a.toml"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, testing::ContainsRegex("assumed +a.toml:4:8: vehicle.car.mass is 1.2 times"));
}

TEST(Plan, FitsOnATerminal) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  std::istringstream lines(run(folder, {"plan", "ball.toml"}).out);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) EXPECT_LE(line.size(), 80u) << line;
  EXPECT_GT(count, 17) << "a line an effect, and those that are broken";
  std::istringstream measured(run(folder, {"plan", "ball.toml", "--measure"}).out);
  for (std::string line; std::getline(measured, line);) EXPECT_LE(line.size(), 80u) << line;
}

TEST(Plan, MeasuresWhatEachEffectCosts) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result = run(folder, {"plan", "ball.toml", "--measure", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const Json measured = Json::parse(result.out);
  double share = 0;
  for (const char* list : {"plan", "phases"})
    for (const Json& line : measured.at(list)) {
      share += line.at("share").get<double>();
      EXPECT_GE(line.at("us_per_step").get<double>(), 0);
      if (line.value("active", true)) continue;
      EXPECT_EQ(line.at("calls"), 0) << line;
      EXPECT_EQ(line.at("us_per_step"), 0) << line;
    }
  EXPECT_NEAR(share, 1, 1e-9);  // time goes to one place only
  EXPECT_EQ(measured.at("steps"), 400);

  const Result text = run(folder, {"plan", "ball.toml", "--measure"});
  EXPECT_THAT(text.out, HasSubstr("us/step"));
  EXPECT_THAT(text.out, HasSubstr("400 steps"));
}

TEST(Plan, SaysThatAnEffectIsForced) {
  const Folder folder;
  const Result result = plan_of_ball(folder, {"--effects", "gravity=off", "--effects", "tyres=on"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("switched off by the author; the scene calls for it: 9.81 m/s^2"));
  EXPECT_THAT(result.out, HasSubstr("all of it, without a bound"));
  EXPECT_THAT(result.out, HasSubstr("switched on by the author, with nothing to do: no vehicle"));
  EXPECT_THAT(run(folder, {"plan", "ball.toml", "--effects", "gravity=off"}).out,
              HasSubstr("warning: effect gravity switched off by the author"));
}

/// Whoever sees only one of them must know.
TEST(ForcedOff, IsSaidInEveryOutputOfTheRun) {
  const Folder folder;
  folder.write("ball.toml", ball_with("stop_at_rest = false", "stop_at_rest = false\neffects = {gravity = \"off\"}"));
  const std::string warning = "effect gravity switched off by the author";
  const Result result = run(folder, {"simulate", "ball.toml", "-o", "out", "-q"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr(warning));
  EXPECT_THAT(contents(folder / "out/summary.json"), HasSubstr(warning));

  const Result studied = run(folder, {"study", "ball.toml", "-o", "study", "--effects", "-q"});
  ASSERT_EQ(studied.code, 0) << studied.err;
  EXPECT_THAT(studied.out, HasSubstr(warning));
  EXPECT_EQ(Json::parse(contents(folder / "study/effects.json")).at("warnings"), Json::array({warning}));
}

TEST(ForcedOff, StandsInThePictureEvenWithoutACaption) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const std::vector<std::string> bare = {"render", "ball.toml",
                                         "--at",   "0.1s",
                                         "--size", "320x180",
                                         "--set",  "overlays.caption=false",
                                         "--set",  "overlays.disclaimer=false",
                                         "-q"};
  std::vector<std::string> without = bare, with = bare;
  without.insert(without.end(), {"-o", "a.png"});
  with.insert(with.end(), {"-o", "b.png", "--effects", "joint_loops=off"});  // which the ball has none of: the motion is the same
  ASSERT_EQ(run(folder, without).code, 0);
  ASSERT_EQ(run(folder, with).code, 0);
  EXPECT_EQ(run(folder, {"compare", "a.png", "b.png"}).code, 1);
}
