// What `simulate` prints: digits, one column, and the words behind a figure. Files and columns are in results_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "cli/output/summary.h"
#include "engine/simulate.h"
#include "tests/cli/program.h"

namespace cli_tests {
namespace {

TEST(Simulate, PrintsNoMoreDigitsThanAMeasureBears) {
  const Folder folder;
  const std::string scene = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/sedan_pedestrian_40kmh.toml";
  const Result result = run(folder, {"simulate", scene, "-q", "-o", "out", "--set", "simulation.duration=1.05 s"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, testing::ContainsRegex("head_impact_s pedestrian +[0-9]\\.[0-9][0-9][0-9]\n"));
  EXPECT_THAT(result.out, testing::ContainsRegex("wrap_around_distance_m pedestrian [0-9]\\.[0-9][0-9]\n"));
  EXPECT_THAT(result.out, testing::ContainsRegex("hic15_vehicle pedestrian +[0-9]+ at 0\\.[0-9]{3} s, by sedan\n"));
  EXPECT_THAT(result.out, testing::ContainsRegex("pdof_deg sedan +[0-9]+\\.[0-9]\n"));
  // the head has struck the bonnet, and its blow is the worst: nothing is the road's
  EXPECT_THAT(result.out, testing::ContainsRegex("hic15 pedestrian +[0-9]+\n"));
  // the same number, whole, for programs
  const nlohmann::json metrics = nlohmann::json::parse(contents(folder / "out/summary.json")).at("metrics");
  EXPECT_NEAR(metrics.at("head_impact_speed_mps").get<double>(),
              std::stod(result.out.substr(result.out.find("head_impact_speed_mps pedestrian") + 33)), 0.0051);
}

/// A criterion over the whole run is the vehicle's where its touches decide it, the road's where that does, and else of neither: a
/// head can strike the person's own arm.
TEST(Simulate, TellsWhatDecidedAHeadInjuryCriterion) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const scenes::Scene scene = scenes::load(folder / "ball.toml");
  const engine::Recording run = engine::simulate(scene.model);
  const auto text = [&](double of_vehicle, double of_road) {
    return cli::summary_text(scene, run, {{"hic15", "p", 36}, {"hic15_vehicle", "p", of_vehicle}, {"hic15_ground", "p", of_road}});
  };
  EXPECT_THAT(text(36, 5), testing::ContainsRegex("hic15 p +36\n"));
  EXPECT_THAT(text(7, 36), testing::ContainsRegex("hic15 p +36, of the road: scatters widely\n"));
  EXPECT_THAT(text(7, 5), testing::ContainsRegex("hic15 p +36, of neither vehicle nor road alone\n"));
}

/// Head first against a wall of either shape: a blow, and no fall on the road.
TEST(Simulate, NamesTheWallThatDecidedAHeadInjuryCriterion) {
  const Folder folder;
  folder.write("wall.obj",
               "v 1.8 -3 0\nv 2.2 -3 0\nv 2.2 3 0\nv 1.8 3 0\nv 1.8 -3 3\nv 2.2 -3 3\nv 2.2 3 3\nv 1.8 3 3\nf 1 4 3 2\nf 5 6 7 8\n"
               "f 1 2 6 5\nf 3 4 8 7\nf 1 5 8 4\nf 2 3 7 6\n");
  for (const std::string shape : {"axes = \"0.2 3 1.5 m\"\nexponent = 30\nposition = \"2 0 1.5 m\"\n", "mesh = \"wall.obj\"\n"}) {
    folder.write("a.toml",
                 "[simulation]\nduration = \"0.5 s\"\n[[person]]\nname = \"p\"\npose = \"lying_prone\"\nheight = \"1 m\"\n"
                 "velocity = \"6 0 0 m/s\"\nzero_condition = false\n[[body]]\nname = \"wall\"\nfixed = true\n" +
                     shape);
    const Result result = run(folder, {"simulate", "a.toml", "-o", "out", "--overwrite"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_THAT(result.out, testing::ContainsRegex("hic15_ground p +[0-9]+ at 0\\.[0-9]{3} s, of wall\n")) << shape;
    EXPECT_THAT(result.out, testing::Not(testing::HasSubstr("of the road"))) << shape;
  }
}

TEST(Simulate, CountsTurnsInWholesAndHasOneNumberForStraightFromBehind) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const scenes::Scene scene = scenes::load(folder / "ball.toml");
  const engine::Recording run = engine::simulate(scene.model);
  const std::string text = cli::summary_text(
      scene, run, {{"quarter_turns", "car", 4}, {"pdof_deg", "car", -179.99}, {"rest_heading_deg", "car", -179.9}});
  EXPECT_THAT(text, testing::ContainsRegex("quarter_turns car +4\n"));
  EXPECT_THAT(text, testing::ContainsRegex("pdof_deg car +180\\.0\n"));
  EXPECT_THAT(text, testing::ContainsRegex("rest_heading_deg car +-179\\.9\n"));
}

/// A car that still moves may turn on; one that is on its wheels again has turned.
TEST(Simulate, MarksTurnsThatAreNotOver) {
  const Folder folder;
  folder.write("a.toml",
               "[simulation]\nduration = \"0.02 s\"\n[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\nspeed = \"9 m/s\"\n");
  const scenes::Scene scene = scenes::load(folder / "a.toml");
  const engine::Recording run = engine::simulate(scene.model);
  const auto text = [&](double turns) {
    return cli::summary_text(scene, run, {{"quarter_turns", "car", turns}, {"roll_distance_m", "car", 7}});
  };
  EXPECT_THAT(text(3), testing::ContainsRegex("quarter_turns car +3 so far, still moving at the end\n"));
  EXPECT_THAT(text(3), testing::ContainsRegex("roll_distance_m car +7\\.00 so far, still moving at the end\n"));
  EXPECT_THAT(text(4), testing::ContainsRegex("quarter_turns car +4\n"));
}

TEST(Simulate, PrintsOneColumnUnderWhatWasChanged) {
  const Folder folder;
  const std::string scene = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/sedan_pedestrian_40kmh.toml";
  const Result result = run(folder, {"simulate", scene, "-q", "-o", "out", "--set", "simulation.duration=0.4 s"});
  ASSERT_EQ(result.code, 0) << result.err;
  std::istringstream lines(result.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "Sedan at 40 km/h strikes a crossing pedestrian [changed: simulation.duration=0.4 s]");
  // the longest name is followed by one blank, and every value begins below its own
  const std::string longest = "  wrap_around_distance_m pedestrian ";
  ASSERT_THAT(result.out, testing::HasSubstr("\n" + longest + "1."));
  int values = 0;
  while (std::getline(lines, line) && line.starts_with("  ")) {
    ASSERT_GT(line.size(), longest.size()) << line;
    EXPECT_EQ(line[longest.size() - 1], ' ') << line;
    EXPECT_NE(line[longest.size()], ' ') << line;
    ++values;
  }
  EXPECT_GT(values, 15);
  EXPECT_THAT(result.out, testing::Not(testing::ContainsRegex(" -0\\.0+\n"))) << "what rounds to nothing has no sign";
}

TEST(Simulate, WhoIsPushedAlongAfterTheLandingIsNotSaidToSlide) {
  const Folder folder;
  const Result result =
      run(folder, {"simulate", std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/suv_child_fit.toml", "-o", "out"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(std::regex_search(result.out, std::regex("slide_m child +[0-9.]+, pushed by a vehicle on the way\n"))) << result.out;
}

/// The parts of a throw that are printed add up to it, each rounded.
TEST(Simulate, PrintsEveryPartOfAThrowThatCanBeSeen) {
  const Folder folder;
  const scenes::Scene scene =
      scenes::load(std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/sedan_pedestrian_40kmh.toml", {"simulation.duration=0.1 s"});
  const engine::Recording run = engine::simulate(scene.model);
  const auto text = [&](double carried) {
    return cli::summary_text(scene, run,
                             {{"throw_distance_m", "pedestrian", 10 + carried},
                              {"contact_m", "pedestrian", 2},
                              {"carried_m", "pedestrian", carried},
                              {"airborne_m", "pedestrian", 5},
                              {"landing_m", "pedestrian", 1},
                              {"landing_s", "pedestrian", 1},
                              {"slide_m", "pedestrian", 2},
                              {"rest_s", "pedestrian", 3}});
  };
  for (const char* part : {"contact_m pedestrian +2\\.00\n", "carried_m pedestrian +3\\.00\n", "airborne_m pedestrian +5\\.00\n",
                           "landing_m pedestrian +1\\.00\n", "slide_m pedestrian +2\\.00\n"})
    EXPECT_THAT(text(3), testing::ContainsRegex(part));
  EXPECT_THAT(text(0.001), testing::Not(testing::HasSubstr("carried_m"))) << "less than the throw is rounded by";
}

TEST(Simulate, VerboseTellsTheEffectsAndTheirCost) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result = run(folder, {"simulate", "ball.toml", "-o", "out", "--verbose"});
  EXPECT_THAT(result.err, testing::HasSubstr("effect gravity: "));
  EXPECT_THAT(result.err, testing::ContainsRegex("effect ground_contact: [0-9]+ calls, [0-9.]+ ms"));
}

}  // namespace
}  // namespace cli_tests

/// A mirror is drawn and strikes nobody: who is reached by it is told, unless something else touched them before.
TEST(PrintedSummary, TellsWhomADrawnMirrorReaches) {
  const Folder folder;
  for (const auto& [name, side, reached] :
       {std::tuple("near", "-1.15", true), std::tuple("far", "-1.6", false), std::tuple("hit", "-0.7", false)}) {
    folder.write(std::string(name) + ".toml", std::string("[simulation]\nduration = \"0.5 s\"\n[[vehicle]]\nname = \"van\"\nmodel "
                                                          "= \"van\"\nfront = \"-1 0 m\"\nspeed = \"50 km/h\"\n") +
                                                  "[[person]]\nname = \"p\"\nposition = \"0 " + side +
                                                  " m\"\nheading = \"90 deg\"\n");
    const Result result = run(folder, {"simulate", std::string(name) + ".toml", "-o", name, "--quiet"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.out.find("van as drawn reaches p/") != std::string::npos, reached) << result.out;
  }
}
