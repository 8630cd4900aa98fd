// One path for stills, sub-ranges and whole films: the number of workers, the range and a death among them change no pixel.
#include "render/film.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "render/error.h"
#include "render/image/png.h"

namespace {

namespace fs = std::filesystem;
using render::Container;
using render::FilmJob;

constexpr int kFrames = 7;  // no multiple of 3 workers

class Film : public testing::Test {
 protected:
  Film() : folder(fs::temp_directory_path() / ("film_test_" + std::to_string(getpid()))) {
    fs::create_directories(folder);
    recording.body_names = {"ball"};
    recording.interval = 0.1;
    for (int i = 0; i <= 10; ++i) {
      engine::Snapshot s;
      s.time = 0.1 * i;
      s.bodies.own().resize(1);
      s.bodies.own()[0].X_WB.p = engine::Vec3(s.time, 0, 1);
      s.bodies.own()[0].V_WB.v = engine::Vec3(1, 0, 0);
      recording.snapshots.push_back(s);
    }
    render::EllipsoidActor ball;
    ball.name = "ball";
    stage.ellipsoids.push_back(ball);
    render::Camera camera;
    camera.name = "side";
    stage.cameras.push_back(camera);
    stage.shots.push_back({"side", 0, 0.1 * kFrames, 1, 0});
  }
  ~Film() override { fs::remove_all(folder); }

  FilmJob job(const std::string& name, int workers) const {
    FilmJob j;
    fs::create_directories(folder / name);
    j.output = folder / name / "f_%03d.png";
    j.container = Container::png_sequence;
    j.width = 64;
    j.height = 48;
    j.quality = render::Quality::draft;
    j.workers = workers;
    j.metadata = {{"title", "a test"}};
    return j;
  }
  std::string bytes(const std::string& path) const {
    std::ifstream file(folder / path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  fs::path folder;
  render::Stage stage;
  engine::Recording recording;
  render::Film film() const { return {stage, recording.end_time(), 10}; }
};

std::string name_of(int frame) {
  return "f_00" + std::to_string(frame) + ".png";
}

TEST_F(Film, OneAndThreeWorkersWriteTheSameBytes) {
  make_film(stage, recording, film(), job("one", 1));
  make_film(stage, recording, film(), job("three", 3));
  for (int i = 0; i < kFrames; ++i) {
    ASSERT_FALSE(bytes("one/" + name_of(i)).empty()) << i;
    EXPECT_EQ(bytes("one/" + name_of(i)), bytes("three/" + name_of(i))) << i;
  }
  // otherwise the comparison would hold for a film that stands still
  EXPECT_NE(render::read_png(folder / "one" / name_of(0)).rgba, render::read_png(folder / "one" / name_of(6)).rgba);
}

TEST_F(Film, ASubRangeAndAStillAreTheWholeFilmsFrames) {
  make_film(stage, recording, film(), job("whole", 2));
  FilmJob part = job("part", 2);
  make_film(stage, recording, film().part({{3, 4}}), part);
  EXPECT_EQ(bytes("part/" + name_of(3)), bytes("whole/" + name_of(3)));
  EXPECT_EQ(bytes("part/" + name_of(4)), bytes("whole/" + name_of(4)));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "part"), fs::directory_iterator()), 2);
  FilmJob still = job("still", 0);
  still.container = Container::single_png;
  still.output = folder / "still" / "s.png";
  make_film(stage, recording, render::Film({film()[3]}), still);
  EXPECT_EQ(bytes("still/s.png"), bytes("whole/" + name_of(3)));
}

TEST_F(Film, AFrameCarriesItsTimeAndProvenance) {
  make_film(stage, recording, film(), job("text", 2));
  render::TextChunks text;
  render::read_png(folder / "text" / name_of(2), &text);
  EXPECT_EQ(text["time_s"], "0.200000");
  EXPECT_EQ(text["title"], "a test");
}

TEST_F(Film, AnExistingFileIsRefusedUnlessOverwritingIsAsked) {
  FilmJob again = job("again", 1);
  make_film(stage, recording, film(), again);
  EXPECT_THROW(make_film(stage, recording, film(), again), render::RenderError);
  again.overwrite = true;
  EXPECT_NO_THROW(make_film(stage, recording, film(), again));
}

TEST_F(Film, AWorkersErrorReachesTheCaller) {
  FilmJob nowhere = job("x", 2);
  nowhere.output = folder / "missing" / "f_%03d.png";
  EXPECT_THROW(make_film(stage, recording, film(), nowhere), render::RenderError);
}

/// Children of this process, from the kernel.
std::vector<pid_t> children() {
  const std::string self = std::to_string(getpid());
  std::ifstream file("/proc/" + self + "/task/" + self + "/children");
  return {std::istream_iterator<pid_t>(file), {}};
}

TEST_F(Film, AKilledWorkersFramesAreDrawnAgain) {
  // enough frames that the ring of 2 slots holds the worker back while it is killed from the first progress report
  FilmJob disturbed = job("killed", 1);
  disturbed.container = Container::mp4;
  disturbed.output = folder / "killed" / "film.mp4";
  const FilmJob calm = [&] {
    FilmJob c = disturbed;
    c.output = folder / "killed" / "calm.mp4";
    return c;
  }();
  make_film(stage, recording, film(), calm);
  int killed = 0;
  make_film(stage, recording, film(), disturbed, [&](const render::FilmProgress& p) {
    if (p.frames_done != 1) return;
    for (const pid_t child : children()) killed += kill(child, SIGKILL) == 0;
  });
  EXPECT_EQ(killed, 1);
  EXPECT_EQ(bytes("killed/film.mp4"), bytes("killed/calm.mp4"));
}

}  // namespace
