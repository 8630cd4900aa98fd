// --dry-run and --max-memory: what a job will cost, told before it starts, held against what it then did cost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/progress.h"
#include "tests/cli/program.h"

using namespace cli_tests;
using testing::AllOf;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;
using Json = nlohmann::json;

namespace {

std::vector<std::string> film(const std::vector<std::string>& more) {
  std::vector<std::string> out = {"render", "ball.toml", "--size", "160x90", "--quality", "draft", "--fps", "10", "-j", "2"};
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

double size_of(const std::filesystem::path& folder) {
  double sum = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) sum += static_cast<double>(file.file_size());
  return sum;
}

class Estimate : public testing::Test {
 protected:
  void SetUp() override { folder.write("ball.toml", kBall); }
  const Folder folder;
};

TEST_F(Estimate, OfAFilmComesTrue) {
  const Result dry = run(folder, film({"-o", "frames", "--dry-run", "--json"}));
  ASSERT_EQ(dry.code, 0) << dry.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "frames")) << "nothing is left behind";
  const Json told = Json::parse(dry.out);
  const Result done = run(folder, film({"-o", "frames", "--json"}));
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(told.at("frames"), Json::parse(done.out).at("frames"));
  EXPECT_EQ(told.at("steps"), 400);
  EXPECT_EQ(told.at("workers"), 2);
  // frames of a ball differ by some tenths of their size
  EXPECT_THAT(told.at("disk_bytes").get<double>() / size_of(folder / "frames"), AllOf(Ge(0.5), Le(2)));
  EXPECT_GT(told.at("seconds").get<double>(), 0);
  EXPECT_THAT(told.at("memory_bytes").get<double>(), AllOf(Ge(50e6), Le(2e9)));
}

TEST_F(Estimate, OfASlowMotionIsThatOfAShortFilmInMemory) {
  const std::string shot = kBall + "[[shot]]\ncamera = \"side\"\nto = \"0.2 s\"\nspeed = ";
  double bytes[2] = {};
  for (const int slow : {0, 1}) {
    folder.write("ball.toml", shot + (slow ? "2e-8\n" : "1\n"));
    const Json told = Json::parse(run(folder, film({"-o", "a.mp4", "--dry-run", "--json"})).out);
    EXPECT_EQ(told.at("frames"), slow ? 100'000'000 : 2);
    bytes[slow] = told.at("memory_bytes").get<double>();
  }
  // what processes hold differs by some pages; a hundred million of anything would be hundreds of megabytes
  EXPECT_NEAR(bytes[1], bytes[0], 20e6);

  folder.write("ball.toml", shot + "1e-12\n");
  const Result refused = run(folder, film({"-o", "a.mp4"}));
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.err,
            "crashreel: with shot.0 (camera side, speed 1e-12) the film has 2e+12 frames at 10 a second, more than the "
            "1000000000 there can be; make it shorter or faster, or take fewer frames a second\n");
}

TEST_F(Estimate, OfResultsComesTrue) {
  const Result dry = run(folder, {"simulate", "ball.toml", "-o", "out", "--dry-run", "--json"});
  ASSERT_EQ(dry.code, 0) << dry.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  ASSERT_EQ(run(folder, {"simulate", "ball.toml", "-o", "out"}).code, 0);
  // rows are as long as their numbers: zeros of a ball that only moves in a plane are short
  EXPECT_THAT(Json::parse(dry.out).at("disk_bytes").get<double>() / size_of(folder / "out"), AllOf(Ge(0.4), Le(2.5)));
}

TEST(ReadableTime, IsOfTheSizeOfWhatItTells) {
  EXPECT_EQ(cli::readable_time(9.84), "9.8 s");
  EXPECT_EQ(cli::readable_time(42.4), "42 s");
  EXPECT_EQ(cli::readable_time(160), "0:02:40");
  EXPECT_EQ(cli::readable_time(9005), "2:30:05");
}

TEST_F(Estimate, OfALongRunIsStretchedFromItsBeginning) {
  // six million steps: more than two seconds of any clock
  folder.write("long.toml",
               ball_with("duration = \"0.4 s\"", "duration = \"600 s\"\nstep = \"0.1 ms\"\nrecord_interval = \"1 ms\""));
  const Result dry = run(folder, {"simulate", "long.toml", "-o", "out", "--dry-run"});
  ASSERT_EQ(dry.code, 0) << dry.err;
  EXPECT_THAT(dry.out, HasSubstr("out: at most 6000000 steps of 0.0001 s, about "));
  // however fast the processor is: nobody reads 1.6e+02 s
  EXPECT_THAT(dry.out, testing::ContainsRegex("on the disk, ([0-9]\\.[0-9] s|[0-9][0-9] s|[0-9]+:[0-5][0-9]:[0-5][0-9])\n"));
  // 600 001 instants of a body each
  EXPECT_THAT(
      run(folder, {"simulate", "long.toml", "-o", "out", "--max-memory", "100 MB"}).err,
      testing::MatchesRegex("crashreel: the job needs about [0-9.]+ [MG]B, --max-memory is 100 MB; a smaller --size, a longer "
                            "record_interval or a shorter duration need less\n"));
}

TEST_F(Estimate, RefusesWhatDoesNotFitBeforeAnythingIsWritten) {
  const Result refused = run(folder, film({"-o", "a.mp4", "--max-memory", "20 MB"}));
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("with one drawing process, --max-memory is 20 MB"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.mp4"));
  for (const char* wrong : {"2", "-1 GB", "nan GB", "1e99 GB", "2 apples", ""})
    EXPECT_EQ(run(folder, film({"-o", "a.mp4", "--max-memory", wrong})).code, *wrong ? 2 : 0) << wrong;
}

TEST_F(Estimate, DrawsWithFewerProcessesWhereAllDoNotFit) {
  const Json told = Json::parse(run(folder, film({"-o", "a.mp4", "--dry-run", "--json"})).out);
  // room for one process and a half
  const double one = (told.at("memory_bytes").get<double>() - 60e6) / 2;
  const std::string ceiling = std::to_string(static_cast<long>((60e6 + 1.6 * one) / 1e6)) + " MB";
  const Result result = run(folder, film({"-o", "a.mp4", "--max-memory", ceiling}));
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("crashreel: 1 drawing process in place of 2, to stay below --max-memory"));
  ASSERT_EQ(run(folder, film({"-o", "b.mp4"})).code, 0);
  EXPECT_EQ(contents(folder / "a.mp4"), contents(folder / "b.mp4"));
}

TEST_F(Estimate, AFilmReplacedByAShorterOneLeavesNoFrameOfTheOldOne) {
  const auto frames = [&] {
    std::vector<std::string> names;
    for (const auto& file : std::filesystem::directory_iterator(folder / "frames")) names.push_back(file.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  };
  ASSERT_EQ(run(folder, film({"-o", "frames"})).code, 0);
  const auto all = frames();
  folder.write("frames/frame_00099.png", "somebody else's");
  const std::vector<std::string> shorter = film({"-o", "frames", "--set", "simulation.duration=0.2 s"});
  const auto with = [](std::vector<std::string> arguments, const char* more) {
    arguments.push_back(more);
    return arguments;
  };
  EXPECT_EQ(run(folder, with(shorter, "--resume")).code, 2) << "what is there is not this film's";
  const Result replaced = run(folder, with(shorter, "--overwrite"));
  EXPECT_EQ(replaced.code, 0) << replaced.err;
  EXPECT_EQ(replaced.err, "crashreel: warning: frames/frame_00099.png is no frame of this film; it was left among them\n");
  EXPECT_LT(frames().size(), all.size());
  EXPECT_THAT(frames(), testing::ElementsAre("frame_00000.png", "frame_00001.png", "frame_00099.png"));
  // a part of a film leaves the rest of it alone
  EXPECT_EQ(run(folder, with(with(film({"-o", "frames", "--overwrite"}), "--frames"), "1")).code, 0);
  EXPECT_EQ(frames().size(), 3u);
}

}  // namespace
