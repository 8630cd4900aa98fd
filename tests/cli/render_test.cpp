// The render command end to end: files, their names, and pictures that do not depend on how they were made.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

using namespace cli_tests;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Json = nlohmann::json;

namespace {

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Small and quick: what is tested here is files, not beauty.
std::vector<std::string> small(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--size", "160x90", "--quality", "draft", "--fps", "10"});
  return arguments;
}

}  // namespace

TEST(Render, WritesAVideoNamedAfterTheSceneAndSaysSo) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result = run(folder, small({"render", "ball.toml"}));
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, testing::MatchesRegex("ball\\.mp4: [45] frames, 160x90, [0-9.]+ s\n"));
  // ISO base media: the second to fourth words name the file type
  EXPECT_EQ(contents(folder / "ball.mp4").substr(4, 4), "ftyp");
  EXPECT_FALSE(std::filesystem::exists(folder / "ball.mp4.part"));
}

TEST(Render, ADivergedRunIsDrawnUpToThere) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  // v = g t passes every bound after 0.2 of the 0.4 s
  const Result result =
      run(folder,
          small({"render", "ball.toml", "-o", "frames", "--set", "simulation.gravity=10000 m/s^2", "--set", "ground.kind=none"}));
  EXPECT_EQ(result.code, 4);
  EXPECT_THAT(result.err, HasSubstr("crashreel: the model diverged at 0.20"));
  EXPECT_THAT(result.err, HasSubstr("body ball, effect gravity"));
  EXPECT_THAT(files_in(folder / "frames"), testing::IsSupersetOf({"frame_00000.png", "frame_00001.png"}));
  EXPECT_THAT(files_in(folder / "frames"), testing::SizeIs(testing::Le(3)));
}

TEST(Render, ASubRangeKeepsTheNumbersAndThePicturesOfTheWholeFilm) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  ASSERT_EQ(run(folder, small({"render", "ball.toml", "-o", "whole", "--jobs", "1"})).code, 0);
  ASSERT_EQ(run(folder, small({"render", "ball.toml", "-o", "part", "--frames", "2:3", "--jobs", "4"})).code, 0);
  EXPECT_THAT(files_in(folder / "part"), ElementsAre("frame_00002.png", "frame_00003.png"));
  EXPECT_EQ(contents(folder / "part/frame_00002.png"), contents(folder / "whole/frame_00002.png"));
  EXPECT_EQ(contents(folder / "part/frame_00003.png"), contents(folder / "whole/frame_00003.png"));
  EXPECT_NE(contents(folder / "whole/frame_00002.png"), contents(folder / "whole/frame_00003.png")) << "the ball falls";
  // the same stretch, asked for by time
  ASSERT_EQ(run(folder, small({"render", "ball.toml", "-o", "time", "--from", "0.2s", "--to", "300 ms"})).code, 0);
  EXPECT_THAT(files_in(folder / "time"), ElementsAre("frame_00002.png", "frame_00003.png"));
}

TEST(Render, OneOrFourJobsGiveTheSameBytes) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  ASSERT_EQ(run(folder, small({"render", "ball.toml", "-o", "one.mp4", "--jobs", "1"})).code, 0);
  ASSERT_EQ(run(folder, small({"render", "ball.toml", "-o", "four.mp4", "--jobs", "4"})).code, 0);
  EXPECT_EQ(contents(folder / "one.mp4"), contents(folder / "four.mp4"));
}

TEST(Render, StillsAreNamedByTheirTimes) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  ASSERT_EQ(run(folder, small({"render", "ball.toml", "-o", "stills/ball.png", "--at", "0.1s", "--at", "200 ms"})).code, 0);
  EXPECT_THAT(files_in(folder / "stills"), ElementsAre("ball_0.100s.png", "ball_0.200s.png"));
  EXPECT_THAT(contents(folder / "stills/ball_0.100s.png"), HasSubstr("PNG"));
  const Result late = run(folder, small({"render", CRASHREEL_SOURCE_DIR "/scenes/gallery/puck_slide.toml", "--set",
                                         "simulation.duration=30 s", "-o", "late.png", "--at", "29 s"}));
  ASSERT_EQ(late.code, 0) << late.err;
  EXPECT_THAT(late.err, testing::ContainsRegex("the run ends at 2\\.[0-9]+ s; a picture of a later time shows its end"));
  // an odd size is no matter for a PNG
  const Result odd =
      run(folder, {"render", "ball.toml", "-o", "one.png", "--at", "0.1", "--size", "161x91", "--quality", "draft", "--json"});
  ASSERT_EQ(odd.code, 0) << odd.err;
  EXPECT_EQ(Json::parse(odd.out).at("files"), Json::array({"one.png"}));
  EXPECT_EQ(Json::parse(odd.out).at("width"), 161);
}

TEST(Render, ListsCamerasAndPlansWithoutWritingAnything) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result cameras = run(folder, {"render", "ball.toml", "--list-cameras"});
  EXPECT_EQ(cameras.code, 0);
  EXPECT_EQ(cameras.out, "side             fixed\nabove            top\n");
  const Result dry = run(folder, {"render", "ball.toml", "--dry-run", "--json", "--size", "320x180"});
  EXPECT_EQ(dry.code, 0) << dry.err;
  const Json plan = Json::parse(dry.out);
  EXPECT_EQ(plan.at("steps"), 400);
  EXPECT_EQ(plan.at("output"), "ball.mp4");
  EXPECT_EQ(plan.at("width"), 320);
  EXPECT_FALSE(std::filesystem::exists(folder / "ball.mp4"));
}

TEST(Render, TellsWhereTheTimeOfItsFramesWent) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result plain = run(folder, small({"render", "ball.toml", "-o", "a.mp4", "--jobs", "2"}));
  const Result told = run(folder, small({"render", "ball.toml", "-o", "b.mp4", "--jobs", "2", "--timings", "--json"}));
  ASSERT_EQ(told.code, 0) << told.err;
  EXPECT_EQ(contents(folder / "a.mp4"), contents(folder / "b.mp4"));
  const Json timings = Json::parse(told.out).at("timings");
  EXPECT_EQ(timings.at("workers"), 2);
  EXPECT_GT(timings.at("first_frame_ms"), timings.at("frame_ms").at("background"));
  for (const char* pass : {"background", "objects", "light", "encode"}) EXPECT_GT(timings.at("frame_ms").at(pass), 0.0) << pass;
  const Result table = run(folder, small({"render", "ball.toml", "-o", "c.mp4", "--timings"}));
  EXPECT_THAT(table.out, HasSubstr("processor time a frame"));
  EXPECT_THAT(plain.out, testing::Not(HasSubstr("processor time")));
}

TEST(Render, AnotherCameraGivesAnotherPicture) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  ASSERT_EQ(run(folder, small({"render", "ball.toml", "-o", "side.png", "--at", "0.1s"})).code, 0);
  ASSERT_EQ(run(folder, small({"render", "ball.toml", "-o", "above.png", "--at", "0.1s", "--camera", "above"})).code, 0);
  EXPECT_NE(contents(folder / "side.png"), contents(folder / "above.png"));
}

TEST(Render, QuietSaysNothingButTheResult) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result quiet = run(folder, small({"render", "ball.toml", "--quiet"}));
  EXPECT_EQ(quiet.code, 0);
  EXPECT_THAT(quiet.err, IsEmpty());
  const Result always = run(folder, small({"render", "ball.toml", "--overwrite", "--progress", "always"}));
  EXPECT_THAT(always.err, HasSubstr("simulate 100 %"));
  EXPECT_THAT(always.err, HasSubstr("draw 100 %"));
}
