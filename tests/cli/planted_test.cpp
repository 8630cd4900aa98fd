// What others put in the program's way: links and pipes under the names it writes, files among its frames, scenes that ask for too
// much; and runs that come together. Nothing of theirs is touched, nothing half-written is left.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <signal.h>
#include <sys/file.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/output/fingerprint.h"
#include "render/video/encoder.h"
#include "scenes/loader/sha256.h"
#include "tests/cli/program.h"

using namespace cli_tests;
using testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> small_film(const std::vector<std::string>& more) {
  std::vector<std::string> out = {"render", "ball.toml", "--size", "64x64", "--quality", "draft", "--fps", "10", "-j", "1"};
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

/// A picture of one bit a pixel: some kilobytes, whatever its size.
void write_black(const fs::path& file, png_uint_32 side) {
  std::FILE* out = std::fopen(file.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, out);
  png_set_IHDR(png, info, side, side, 1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::vector<png_byte> row(side / 8 + 1);
  for (png_uint_32 y = 0; y < side; ++y) png_write_row(png, row.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(out);
}

class Planted : public testing::Test {
 protected:
  void SetUp() override { folder.write("ball.toml", kBall); }
  pid_t start(const std::vector<std::string>& arguments) const {
    const pid_t child = fork();
    if (child != 0) return child;
    if (chdir(folder.path().c_str()) != 0) _exit(99);
    const int log = open("log", O_WRONLY | O_CREAT | O_APPEND, 0666);
    dup2(log, 1);
    dup2(log, 2);
    std::vector<char*> list{const_cast<char*>(program())};
    for (const std::string& argument : arguments) list.push_back(const_cast<char*>(argument.c_str()));
    list.push_back(nullptr);
    execv(program(), list.data());
    _exit(98);
  }
  static int end_of(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  const Folder folder;
};

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n";
std::string car(const std::string& mesh) {
  return "[[vehicle]]\nname = \"car\"\nmesh = \"" + mesh +
         "\"\nmass = \"1500 kg\"\ncg = \"0.1 0 0.5 m\"\ninertia = \"500 2500 2600 kg m^2\"\nfront = \"0 0 m\"\n";
}
std::string ground(const std::string& picture) {
  return kBall + "[road]\npicture = \"" + picture + "\"\npicture_width = \"10 m\"\n";
}

}  // namespace

TEST_F(Planted, ALosslessFilmIsKnownAgain) {
  ASSERT_EQ(run(folder, small_film({"-o", "a.mkv", "--resume"})).code, 0);
  const std::string whole = contents(folder / "a.mkv");
  EXPECT_EQ(run(folder, small_film({"-o", "a.mkv", "--resume"})).code, 0);
  EXPECT_EQ(contents(folder / "a.mkv"), whole);
}

TEST_F(Planted, FramesOfTwoRunsHaveTwoFingerprints) {
  // another processor's recording is another accident, though scene, options and version are the same
  const scenes::Scene scene = scenes::load(folder / "ball.toml");
  CLI::App app;
  const cli::Arguments arguments(app);
  using cli::ResultKind;
  for (const ResultKind kind : {ResultKind::frame, ResultKind::whole}) {
    EXPECT_NE(cli::fingerprint(kind, scene, arguments, 1), cli::fingerprint(kind, scene, arguments, 2));
    EXPECT_NE(cli::fingerprint(kind, scene, arguments, 1), cli::fingerprint(kind, scene, arguments));
  }
  // and the frames carry it
  ASSERT_EQ(run(folder, {"simulate", "ball.toml", "-o", "out"}).code, 0);
  const std::string hash = nlohmann::json::parse(contents(folder / "out/summary.json"))["recording"]["hash"];
  ASSERT_EQ(run(folder, {"render", "ball.toml", "-o", "a.mp4"}).code, 0);
  EXPECT_EQ(render::read_film_metadata(folder / "a.mp4").at("fingerprint"),
            cli::fingerprint(ResultKind::whole, scene, arguments, std::stoull(hash, nullptr, 16)));
}

TEST_F(Planted, ASceneFromAPipeIsHashedAsItWasRead) {
  folder.write("other.toml", ball_with("1 0 0 m/s", "2 0 0 m/s"));
  ASSERT_EQ(under_shell(folder, "cat ball.toml | $P simulate /dev/stdin -o out --resume >/dev/null").code, 0);
  EXPECT_THAT(contents(folder / "out/summary.json"), HasSubstr(scenes::sha256(kBall)));
  EXPECT_EQ(under_shell(folder, "cat ball.toml | $P simulate /dev/stdin -o out --resume >said").code, 0);
  EXPECT_EQ(contents(folder / "said"), "out: finished before\n");
  EXPECT_EQ(under_shell(folder, "cat other.toml | $P simulate /dev/stdin -o out --resume >/dev/null 2>&1").code, 2);
  ASSERT_EQ(under_shell(folder, "cat ball.toml | $P render /dev/stdin -o a.mp4 --size 64x64 -j 1 --resume >/dev/null").code, 0);
  EXPECT_EQ(under_shell(folder, "cat other.toml | $P render /dev/stdin -o a.mp4 --size 64x64 -j 1 --resume >/dev/null 2>&1").code,
            2);
}

TEST_F(Planted, AFinishedResultIsPrintedAgainAndAPartOfOneIsNone) {
  const std::vector<std::string> job = {"simulate", "ball.toml", "-o", "out", "-q", "--resume", "--json"};
  const std::string first = run(folder, job).out;
  EXPECT_EQ(run(folder, job).out, first);
  EXPECT_EQ(first, contents(folder / "out/summary.json"));
  fs::remove(folder / "out/contacts.csv");
  EXPECT_EQ(run(folder, job).code, 0);
  EXPECT_TRUE(fs::exists(folder / "out/contacts.csv"));
}

TEST_F(Planted, ResumeRemovesOnlyWhatItMade) {
  fs::create_directories(folder / "a.mp4.frames/photos");
  folder.write("a.mp4.frames/photos/only_copy.jpg", "mine");
  folder.write("a.mp4.frames/frame_00900.png", "mine too");
  const Result result = run(folder, small_film({"-o", "a.mp4", "--resume"}));
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.err, HasSubstr("a.mp4.frames holds files that are no frames of this film; it was left"));
  EXPECT_EQ(names_in(folder / "a.mp4.frames"), (std::vector<std::string>{"frame_00900.png", "photos"}));
  EXPECT_EQ(run(folder, small_film({"-o", "a.mp4", "--resume"})).code, 0);
  EXPECT_EQ(contents(folder / "a.mp4.frames/photos/only_copy.jpg"), "mine");
}

TEST_F(Planted, LinksUnderTheNamesOfPartsAreNotFollowed) {
  folder.write("victim", "precious");
  fs::create_directory(folder / "out");
  for (const char* name : {"a.mp4.part", "a.mp4.whole.part", "out/trajectory.csv.part", "still.png.part"})
    fs::create_symlink(folder / "victim", folder / name);
  EXPECT_EQ(run(folder, small_film({"-o", "a.mp4"})).code, 0);
  EXPECT_EQ(run(folder, {"simulate", "ball.toml", "-o", "out"}).code, 0);
  EXPECT_EQ(run(folder, {"render", "ball.toml", "--size", "64x64", "--at", "0.1s", "-o", "still.png"}).code, 0);
  EXPECT_EQ(contents(folder / "victim"), "precious");
  for (const char* name : {"a.mp4", "out/trajectory.csv", "still.png"}) EXPECT_FALSE(fs::is_symlink(folder / name)) << name;
  // who guesses the number of the process gets no further
  const std::string prefix = "exec timeout 20 sh -c '";
  for (const char* plant : {"ln -s ../victim", "mkfifo", "ln -s /dev/null"}) {
    EXPECT_EQ(under_shell(folder, prefix + plant +
                                      " out/trajectory.csv.$$.part; exec \"$0\" simulate ball.toml -o out --overwrite' $P 2>said")
                  .code,
              3);
    EXPECT_THAT(contents(folder / "said"), HasSubstr("is in the way and is no plain file"));
    for (const std::string& name : names_in(folder / "out"))
      if (name.ends_with(".part")) fs::remove(folder / ("out/" + name));
  }
  EXPECT_EQ(contents(folder / "victim"), "precious");
}

TEST_F(Planted, WhatAKilledRunLeftIsTakenAway) {
  fs::create_directory(folder / "out");
  folder.write("out/trajectory.csv.4711.part", "half");
  folder.write("out/notes.4711.part", "not ours");
  folder.write("a.mp4.4711.part", "half");
  folder.write("a.mp4.whole.4711.part", "half");
  EXPECT_EQ(run(folder, {"simulate", "ball.toml", "-o", "out"}).code, 0);
  EXPECT_EQ(run(folder, small_film({"-o", "a.mp4"})).code, 0);
  EXPECT_EQ(names_in(folder / "out"), (std::vector<std::string>{"contacts.csv", "impacts.csv", "notes.4711.part", "recording.bin",
                                                                "summary.json", "trajectory.csv"}));
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{".stderr", ".stdout", "a.mp4", "ball.toml", "out"}));
}

TEST_F(Planted, EveryCommandThatWritesHoldsALock) {
  fs::create_directory(folder / "scenes");
  folder.write("scenes/ball.toml", kBall + "[[output.still]]\ntime = \"0.1 s\"\n");
  fs::create_directory(folder / "out");
  const std::vector<std::pair<std::string, std::vector<std::string>>> jobs = {
      {"out/study.lock", {"study", "ball.toml", "-o", "out"}},
      {"out/figures.lock", {"figure", "ball.toml", "-o", "out"}},
      {"snapshot-report.lock", {"snapshot", "scenes"}},
      {"out/summary.json.lock", {"simulate", "ball.toml", "-o", "out"}}};
  for (const auto& [lock, job] : jobs) {
    const int other = open((folder / lock).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    ASSERT_EQ(flock(other, LOCK_EX | LOCK_NB), 0);
    const Result refused = run(folder, job);
    EXPECT_EQ(refused.code, 3) << lock;
    EXPECT_THAT(refused.err, HasSubstr("another run is writing")) << lock;
    close(other);
  }
}

TEST_F(Planted, OfTwoRunsAtOnceEachEndsWithItsResultOrIsRefused) {
  fs::create_directory(folder / "scenes");
  folder.write("scenes/ball.toml", kBall + "[snapshot]\nwidth = 64\nheight = 64\n[[output.still]]\ntime = \"0.1 s\"\n");
  const std::vector<std::vector<std::string>> jobs = {
      {"figure", "ball.toml", "-o", "figures", "--size", "64x64", "--quality", "draft", "--overwrite"},
      {"snapshot", "scenes", "--update", "ball"},
      {"simulate", "ball.toml", "-o", "out", "--overwrite"},
      small_film({"-o", "a.mp4", "--overwrite"})};
  for (const auto& job : jobs)
    for (int pair = 0; pair < 3; ++pair) {
      const pid_t first = start(job), second = start(job);
      for (const int code : {end_of(first), end_of(second)}) EXPECT_TRUE(code == 0 || code == 3) << job[0] << code;
      const std::string log = contents(folder / "log");
      EXPECT_EQ(log.find("No such file"), std::string::npos) << job[0] << log;
    }
  for (const auto& entry : fs::recursive_directory_iterator(folder.path())) {
    EXPECT_FALSE(entry.path().string().ends_with(".part")) << entry.path();
    EXPECT_FALSE(entry.path().string().ends_with(".lock")) << entry.path();
    EXPECT_TRUE(entry.path().extension() != ".pdf" || contents(entry.path()).find("%%EOF") != std::string::npos) << entry.path();
  }
}

TEST_F(Planted, AHangupEndsARunAsOtherSignalsDo) {
  folder.write("long.toml", ball_with("duration = \"0.4 s\"", "duration = \"600 s\"\nstep = \"0.1 ms\""));
  fs::create_directory(folder / "scenes");
  folder.write("scenes/long.toml", contents(folder / "long.toml") + "[[output.still]]\ntime = \"500 s\"\n");
  const std::vector<std::vector<std::string>> jobs = {{"simulate", "long.toml", "-o", "out"},
                                                      {"study", "long.toml", "-o", "study", "--jobs", "1"},
                                                      {"snapshot", "scenes", "-j", "1"}};
  for (const auto& job : jobs)
    for (const int signal : {SIGHUP, SIGTERM}) {
      fs::remove(folder / "log");
      const pid_t child = start(job);
      std::this_thread::sleep_for(std::chrono::milliseconds(700));
      kill(child, signal);
      const auto asked = std::chrono::steady_clock::now();
      EXPECT_EQ(end_of(child), 128 + signal) << job[0];
      EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::seconds(2)) << job[0];
      EXPECT_THAT(contents(folder / "log"), HasSubstr(signal == SIGHUP ? "stopped by SIGHUP" : "stopped by SIGTERM")) << job[0];
    }
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    EXPECT_FALSE(entry.path().string().ends_with(".lock")) << entry.path();
}

TEST_F(Planted, ARunStoppedTwiceEndsAtOnceAndLeavesNoLock) {
  folder.write("long.toml", ball_with("duration = \"0.4 s\"", "duration = \"600 s\"\nstep = \"0.1 ms\""));
  const pid_t child = start({"study", "long.toml", "-o", "out", "--jobs", "1"});
  const auto at_work = [this] { return fs::exists(folder / "out/runs"); };
  for (int look = 0; look < 10'000 && !at_work(); ++look) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_TRUE(at_work());
  kill(child, SIGSTOP);  // both are there when it goes on
  kill(child, SIGTERM);
  kill(child, SIGHUP);
  kill(child, SIGCONT);
  EXPECT_THAT(end_of(child), testing::AnyOf(128 + SIGTERM, 128 + SIGHUP));
  EXPECT_THAT(contents(folder / "log"), HasSubstr("finished runs are kept in out/runs"));
  EXPECT_FALSE(fs::exists(folder / "out/study.lock"));
}

TEST_F(Planted, AFullDiskLeavesNoPartOfAFigure) {
  EXPECT_EQ(
      under_shell(folder, "ulimit -f 1; $P figure ball.toml -o figures --size 64x64 --quality draft 2>/dev/null >/dev/null").code,
      3);
  for (const std::string& name : names_in(folder / "figures")) EXPECT_FALSE(name.ends_with(".part")) << name;
}

TEST_F(Planted, APictureMayHaveSixtyFourMillionPixels) {
  write_black(folder / "ground.png", 16384);
  folder.write("bomb.toml", ground("ground.png"));
  const Result refused = run(folder, {"check", "bomb.toml"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("it has more than 64 million pixels"));
}

TEST_F(Planted, APictureIsHeldToTheCeilingOfMemory) {
  // while it is read it needs 600 MB
  folder.write("bomb.toml", ground("ground.png"));
  write_black(folder / "ground.png", 8000);
  EXPECT_EQ(run(folder, {"simulate", "bomb.toml", "-o", "out", "--max-memory", "300 MB"}).code, 3);
  EXPECT_EQ(run(folder, {"simulate", "bomb.toml", "-o", "out", "--max-memory", "1 GB"}).code, 0);
}

TEST_F(Planted, ScenesCheckedAtOnceShareOneCeilingOfMemory) {
  // while the picture is read it needs 600 MB; a scene may take half of what there is, and its importer the other half
  fs::create_directories(folder / "scenes");
  const std::string still = "\n[output]\nsize = [64, 64]\n\n[[output.still]]\ntime = '0 s'\n";
  folder.write("scenes/bomb.toml", ground("ground.png") + still);
  folder.write("scenes/ball.toml", contents(folder / "ball.toml") + still);
  write_black(folder / "scenes/ground.png", 8000);
  const auto check = [this](const std::string& memory) {
    return run(folder, {"snapshot", "scenes", "-j", "2", "--max-memory", memory, "--json"});
  };
  const Result small = check("999 MB");
  EXPECT_THAT(small.err, HasSubstr("1 scene at once in place of 2, to stay below 999 MB of memory"));
  EXPECT_THAT(small.out, HasSubstr("not enough memory; with fewer --jobs, or more for --max-memory, each scene may take more"));
  const Result large = check("3 GB");
  EXPECT_THAT(large.err, Not(HasSubstr("at once in place of")));
  EXPECT_THAT(large.out, Not(HasSubstr("not enough memory")));
}

TEST_F(Planted, AFilmIsReadAsTheContainerItsNameSays) {
  // opened, the pipe would hold the run for ever
  folder.write("a.mp4", "#EXTM3U\n#EXT-X-VERSION:3\n#EXT-X-TARGETDURATION:10\n#EXTINF:9.9,\nsecret.ts\n#EXT-X-ENDLIST\n");
  EXPECT_EQ(
      under_shell(folder, "mkfifo secret.ts; timeout 20 $P render ball.toml --size 64x64 -j 1 -o a.mp4 --resume 2>/dev/null").code,
      2);
  folder.write("b.mkv", "ffconcat version 1.0\nfile secret.ts\n");
  EXPECT_EQ(under_shell(folder, "timeout 20 $P render ball.toml --size 64x64 -j 1 -o b.mkv --resume 2>/dev/null").code, 2);
}

TEST_F(Planted, ASceneReadsBelowItsFolderOnly) {
  fs::create_directories(folder / "scene");
  fs::create_directories(folder / "elsewhere");
  folder.write("elsewhere/car.obj", kTriangle);
  write_black(folder / "elsewhere/ground.png", 64);
  fs::create_symlink(folder / "elsewhere/car.obj", folder / "scene/link.obj");
  fs::create_directory_symlink(folder / "elsewhere", folder / "scene/way");
  const std::string there = (folder / "elsewhere").string();
  for (const std::string& text : {car("../elsewhere/car.obj"), car(there + "/car.obj"), car("link.obj"), car("way/car.obj"),
                                  ground("../elsewhere/ground.png"), ground("way/ground.png")}) {
    folder.write("scene/scene.toml", text);
    const Result refused = run(folder, {"check", "scene/scene.toml"});
    EXPECT_EQ(refused.code, 2) << text;
    EXPECT_THAT(refused.err, HasSubstr("lies outside the scene's folder; where you trust the scene, give --allow"));
    EXPECT_EQ(run(folder, {"check", "scene/scene.toml", "--allow", "elsewhere"}).code, 0) << text;
  }
}

TEST_F(Planted, ACrowdIsRefusedInSeconds) {
  std::string text = kBall;
  for (int i = 0; i < 100'000; ++i)
    text += "[[body]]\nname = \"b" + std::to_string(i) + "\"\nmass = \"1 kg\"\naxes = \"1 1 1 m\"\n";
  folder.write("crowd.toml", text);
  const auto before = std::chrono::steady_clock::now();
  const Result refused = run(folder, {"check", "crowd.toml"});
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(20));
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("body is there 100001 times; a scene has at most 10000"));
}

TEST_F(Planted, ControlCharactersReachNoTerminal) {
  folder.write("ball.toml", ball_with("title = \"Ball\"", "title = \"Ball \\u001b[2J\\u009b2J\\u0007\""));
  const Result result = run(folder, {"simulate", "ball.toml", "-o", "out"});
  ASSERT_EQ(result.code, 0);
  EXPECT_THAT(result.out, HasSubstr("Ball ?[2J"));
  for (const std::string& text : {result.out, result.err}) {
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
    EXPECT_EQ(text.find("\xc2\x9b"), std::string::npos);
    EXPECT_EQ(text.find('\a'), std::string::npos);
  }
}
