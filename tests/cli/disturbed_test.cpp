// What the program does in bad places: streams closed, no descriptors, a file-size limit, two runs at once, signals; and --resume.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "tests/cli/program.h"

using namespace cli_tests;
using testing::HasSubstr;

namespace {

const std::vector<std::string> kFilm = {"render", "ball.toml", "--size", "64x64", "--quality", "draft", "--fps", "10", "-j", "1"};

std::vector<std::string> film(const std::vector<std::string>& more) {
  std::vector<std::string> out = kFilm;
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

class Disturbed : public testing::Test {
 protected:
  void SetUp() override { folder.write("ball.toml", kBall); }
  const Folder folder;
};

}  // namespace

TEST_F(Disturbed, AColonInAFileNameIsNoProtocol) {
  EXPECT_EQ(run(folder, film({"-o", "a:b.mp4"})).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "a:b.mp4"));
}

TEST_F(Disturbed, ClosedOrFullStandardErrorCostsNothing) {
  const std::string line = "$P render ball.toml --size 64x64 --fps 10 -j 1 --progress always -v ";
  EXPECT_EQ(under_shell(folder, line + "-o closed.mp4 2>&- >/dev/null").code, 0);
  EXPECT_EQ(under_shell(folder, line + "-o full.mp4 2>/dev/full >/dev/null").code, 0);
  EXPECT_EQ(run(folder, {"render", "ball.toml", "--size", "64x64", "--fps", "10", "-o", "open.mp4"}).code, 0);
  // nothing printed went into a film
  EXPECT_EQ(contents(folder / "closed.mp4"), contents(folder / "open.mp4"));
  EXPECT_EQ(contents(folder / "full.mp4"), contents(folder / "open.mp4"));
}

TEST_F(Disturbed, ResultsThatNobodyCanReadAreAnError) {
  EXPECT_EQ(under_shell(folder, "$P plan ball.toml >&- 2>/dev/null").code, 3);
  EXPECT_EQ(under_shell(folder, "$P plan ball.toml >/dev/full 2>/dev/null").code, 3);
}

TEST_F(Disturbed, WithoutHomeAndEnvironment) {
  EXPECT_EQ(under_shell(folder, "env -i $P render ball.toml --size 64x64 --fps 10 -j 1 -o a.mp4 >/dev/null 2>&1").code, 0);
}

TEST_F(Disturbed, WithoutAFontNoPictureIsMade) {
  // a picture without its letters lacks the words that it is a simulation
  folder.write("fonts.conf", "<?xml version=\"1.0\"?><fontconfig><dir>none</dir><cachedir>cache</cachedir></fontconfig>");
  EXPECT_EQ(
      under_shell(folder, "FONTCONFIG_FILE=$PWD/fonts.conf $P render ball.toml --size 64x64 --at 0.1s -o a.png 2>message").code, 3);
  EXPECT_THAT(contents(folder / "message"), HasSubstr("the system has no font; install DejaVu Sans"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST_F(Disturbed, TooFewDescriptorsAreToldAndNothingIsLeft) {
  // closed first: what runs the tests leaves descriptors open
  for (const auto& [most, what] : {std::pair("4", "libOSMesa"), std::pair("5", "a.mp4")}) {
    const std::string limited = std::string("(exec 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&-; ulimit -n ") + most + "; ";
    EXPECT_EQ(under_shell(folder, limited + "exec $P render ball.toml --size 64x64 -j 1 -o a.mp4) 2>message").code, 3);
    EXPECT_THAT(contents(folder / "message"), HasSubstr(what));
    EXPECT_THAT(contents(folder / "message"), HasSubstr("Too many open files"));
    EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"ball.toml", "message"}));
  }
}

TEST_F(Disturbed, AFileTooLargeForItsPlaceIsToldAndNothingIsLeft) {
  // one block of 512 or 1024 bytes: less than any result
  EXPECT_EQ(under_shell(folder, "ulimit -f 1; $P simulate ball.toml -o out 2>message >/dev/null").code, 3);
  EXPECT_THAT(contents(folder / "message"), HasSubstr("File too large"));
  EXPECT_TRUE(names_in(folder / "out").empty());
  EXPECT_EQ(under_shell(folder, "ulimit -f 1; $P render ball.toml --size 64x64 -j 1 -o a.mp4 2>message >/dev/null").code, 3);
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"ball.toml", "message", "out"}));
}

TEST_F(Disturbed, TwoRunsDoNotWriteOneOutput) {
  const std::string name = (folder / "a.mp4.lock").string();
  const int other = open(name.c_str(), O_RDWR | O_CREAT, 0666);
  ASSERT_EQ(flock(other, LOCK_EX | LOCK_NB), 0);
  const Result refused = run(folder, film({"-o", "a.mp4"}));
  EXPECT_EQ(refused.code, 3);
  EXPECT_EQ(refused.err, "crashreel: another run is writing a.mp4; wait for it, or give another -o\n");
  close(other);
  // the file alone holds nobody off: its owner may have been killed
  EXPECT_EQ(run(folder, film({"-o", "a.mp4"})).code, 0);
  EXPECT_FALSE(std::filesystem::exists(name));
}

TEST_F(Disturbed, SignalsEndARunWithinTwoSeconds) {
  // six million steps: a minute
  folder.write("long.toml", ball_with("duration = \"0.4 s\"", "duration = \"600 s\"\nstep = \"0.1 ms\""));
  for (const int signal : {SIGINT, SIGTERM}) {
    const pid_t child = fork();
    if (child == 0) {
      if (chdir(folder.path().c_str()) != 0) _exit(99);
      execl(program(), program(), "simulate", "long.toml", "-q", "-o", "out", nullptr);
      _exit(98);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    kill(child, signal);
    const auto asked = std::chrono::steady_clock::now();
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::seconds(2));
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 128 + signal);
    EXPECT_TRUE(names_in(folder / "out").empty());
  }
}

TEST_F(Disturbed, AnAlarmOfSomebodyElseEndsNothing) {
  folder.write("some.toml", ball_with("duration = \"0.4 s\"", "duration = \"20 s\"\nstep = \"0.1 ms\""));
  EXPECT_EQ(under_shell(folder,
                        "{ $P simulate some.toml -q -o out >told 2>&1 & } ; run=$!; until [ -e out/summary.json.lock ]; do "
                        "sleep 0.02; done; kill -ALRM $run; wait $run")
                .code,
            0);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/summary.json"));
}

TEST_F(Disturbed, AStoppedRunTellsWhatIsKept) {
  folder.write("long.toml", ball_with("duration = \"0.4 s\"", "duration = \"600 s\"\nstep = \"0.1 ms\""));
  // it is stopped while it simulates: some time after it holds its lock
  const auto stopped = [this](const std::string& command, const std::string& lock) {
    under_shell(folder, "{ $P " + command + " -q 2>told & } ; run=$!; until [ -e " + lock +
                            " ]; do sleep 0.05; done; sleep 1; kill -TERM $run; wait $run");
    return contents(folder / "told");
  };
  EXPECT_EQ(stopped("simulate long.toml -o out", "out/summary.json.lock"),
            "crashreel: stopped by SIGTERM; nothing was kept; the same command begins anew\n");
  EXPECT_EQ(stopped("render long.toml -o a.mp4", "a.mp4.lock"),
            "crashreel: stopped by SIGTERM; nothing was kept; with --resume a film keeps its finished frames\n");
  EXPECT_EQ(stopped("render long.toml -o b.mp4 --resume", "b.mp4.lock"),
            "crashreel: stopped by SIGTERM; finished frames are kept, and the same command goes on from there\n");
  EXPECT_EQ(stopped("sample " CRASHREEL_SOURCE_DIR "/scenes/gallery/sample_puck.toml -n 6000 -o s", "s/runs.lock"),
            "crashreel: stopped by SIGTERM; finished runs are kept in s/runs, and the same command goes on from there\n");
}

TEST_F(Disturbed, ResumedFramesAreThoseOfAnUndisturbedRun) {
  ASSERT_EQ(run(folder, film({"-o", "whole"})).code, 0);
  ASSERT_EQ(run(folder, film({"-o", "part", "--frames", "1:1"})).code, 0);
  ASSERT_EQ(run(folder, film({"-o", "part", "--resume"})).code, 0);
  EXPECT_EQ(names_in(folder / "part"), names_in(folder / "whole"));
  for (const std::string& name : names_in(folder / "whole"))
    EXPECT_EQ(contents(folder / ("part/" + name)), contents(folder / ("whole/" + name))) << name;
}

TEST_F(Disturbed, AResumedFilmIsThatOfAnUndisturbedRun) {
  ASSERT_EQ(run(folder, film({"-o", "whole.mp4"})).code, 0);
  ASSERT_EQ(run(folder, film({"-o", "resumed.mp4", "--resume"})).code, 0);
  // it names another file, but holds the same scene: the same bytes
  EXPECT_EQ(contents(folder / "resumed.mp4"), contents(folder / "whole.mp4"));
  EXPECT_FALSE(std::filesystem::exists(folder / "resumed.mp4.frames"));
  EXPECT_EQ(run(folder, film({"-o", "resumed.mp4", "--resume"})).code, 0);
}

TEST_F(Disturbed, ResumeRefusesWhatIsNotItsOwn) {
  ASSERT_EQ(run(folder, film({"-o", "frames"})).code, 0);
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{"--set", "body.ball.mass=\"3 kg\""}, {"--quality", "fine"}}) {
    std::vector<std::string> arguments = film({"-o", "frames", "--resume"});
    arguments.insert(arguments.end(), other.begin(), other.end());
    const Result refused = run(folder, arguments);
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("was not made by this scene with these assets, options and version"));
  }
  EXPECT_EQ(run(folder, film({"-o", "frames", "--resume", "--overwrite"})).code, 2);
}

TEST_F(Disturbed, ResumedResultsAreKeptWhenTheyAreWhole) {
  ASSERT_EQ(run(folder, {"simulate", "ball.toml", "-o", "out", "-q"}).code, 0);
  const auto before = std::filesystem::last_write_time(folder / "out/trajectory.csv");
  EXPECT_EQ(run(folder, {"simulate", "ball.toml", "-o", "out", "-q", "--resume"}).code, 0);
  EXPECT_EQ(std::filesystem::last_write_time(folder / "out/trajectory.csv"), before);
  std::filesystem::remove(folder / "out/summary.json");
  EXPECT_EQ(run(folder, {"simulate", "ball.toml", "-o", "out", "-q", "--resume"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/summary.json"));
}
