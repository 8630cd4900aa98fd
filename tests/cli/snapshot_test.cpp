// crashreel snapshot on small folders of scenes: every verdict, pinned measures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/image/png.h"
#include "tests/cli/snapshot_folder.h"

using namespace cli_tests;
using testing::HasSubstr;

TEST(Snapshot, ANewPictureFailsUntilSomebodyAcceptsIt) {
  const Accepted folder;
  EXPECT_EQ(folder.first.code, 1);
  EXPECT_THAT(folder.first.out, HasSubstr("new        ball.toml: " + kName + ": it has no baseline yet"));
  EXPECT_EQ(folder.accepted.code, 0);
  EXPECT_EQ(contents(folder / "scenes/snapshots/list.txt"), kName + "\n");
  const Result again = folder.again();
  EXPECT_EQ(again.code, 0) << again.out;
  EXPECT_EQ(folder.report()["scenes"][0]["pictures"][0]["figures"]["pixels_differing"], 0);
}

TEST(Snapshot, AChangedPictureFailsAndIsShown) {
  const Accepted folder;
  folder.write("scenes/ball.toml", moved_ball());
  const Result changed = folder.again();
  EXPECT_EQ(changed.code, 1);
  EXPECT_THAT(changed.out, HasSubstr("different  ball.toml: " + kName));
  const Json picture = folder.report()["scenes"][0]["pictures"][0];
  for (const char* kind : {"expected", "actual", "difference", "side_by_side"})
    EXPECT_NO_THROW(render::read_png(folder / ("snapshot-report/" + picture[kind].get<std::string>()))) << kind;
  // wider limits of the scene let it pass
  folder.write("scenes/ball.toml", moved_ball() +
                                       "[snapshot.limits]\nshare_above_2 = 1\npixels_above_32 = 1e6\nrms = 255\npsnr_dB = 0\n"
                                       "ssim = 0\nperceptual_mean = 1\nperceptual_worst = 1\n");
  EXPECT_EQ(folder.again().code, 0);
  // and so does a mask over all of it
  folder.write("scenes/ball.toml", moved_ball() + "[[snapshot.mask]]\ncamera = \"side\"\nwidth = 160\nheight = 90\n");
  EXPECT_EQ(folder.again().code, 0);
  folder.write("scenes/ball.toml", moved_ball() + "[[snapshot.mask]]\ncamera = \"above\"\nwidth = 160\nheight = 90\n");
  EXPECT_EQ(folder.again().code, 1) << "the mask is another camera's";
}

TEST(Snapshot, MissingOrphanedAndUnreadableBaselinesAreToldApart) {
  const Accepted folder;
  fs::copy_file(folder.baseline(), folder.baseline("old"));
  const Result orphaned = folder.again();
  EXPECT_EQ(orphaned.code, 1);
  EXPECT_THAT(orphaned.out, HasSubstr("orphaned   no scene names scenes/snapshots/old.png"));
  EXPECT_EQ(folder.again({"--update", "old"}).code, 0);
  EXPECT_FALSE(fs::exists(folder.baseline("old")));

  fs::resize_file(folder.baseline(), 100);
  EXPECT_THAT(folder.again().out, HasSubstr("unreadable ball.toml: " + kName));
  fs::remove(folder.baseline());
  EXPECT_THAT(folder.again().out, HasSubstr("missing    ball.toml: " + kName + ": its baseline was accepted once and is gone"));

  render::write_png(folder.baseline(), {16, 16, std::vector<std::uint8_t>(4 * 16 * 16, 200)});
  EXPECT_THAT(folder.again().out, HasSubstr("the baseline is 16x16, the picture 160x90"));
}

TEST(Snapshot, PinnedMeasuresTellPhysicsFromDrawing) {
  // 1 m/s over 0.4 s, less what friction on the ground took: between a third and all of 0.4 m
  const Accepted folder("[expect]\ntravel = \"0.27 m +- 0.13 m\"\n");
  EXPECT_EQ(folder.again().code, 0);
  // another place changes the picture, not how far it goes
  std::string scene = ball_with("0 0 0.3 m", "0.03 0 0.3 m");
  folder.write("scenes/ball.toml", scene + "[expect]\ntravel = \"0.27 m +- 0.13 m\"\n" + kStill);
  EXPECT_THAT(folder.again().out, HasSubstr("every pinned measure holds: look at the drawing first"));
  scene = ball_with("1 0 0 m/s", "2 0 0 m/s");
  folder.write("scenes/ball.toml", scene + "[expect]\ntravel = \"0.27 m +- 0.13 m\"\n" + kStill);
  const Result faster = folder.again();
  EXPECT_EQ(faster.code, 1);
  EXPECT_THAT(faster.out, HasSubstr("different  ball.toml: travel_m: is 0."));
  EXPECT_THAT(faster.out, HasSubstr("look at the physics first"));
  folder.write("scenes/ball.toml", kBall + "[expect]\nthrow_distance = \"1 m +- 1 cm\"\n" + kStill);
  EXPECT_THAT(folder.again().out,
              HasSubstr("missing    ball.toml: throw_distance_m: the run has no such measure; the run has travel_m ball"));
}

TEST(Snapshot, APhysicsFaultNoPictureShowsIsSeenInItsMeasure) {
  // friction acts from the landing at 0.2 s; the picture is of the flight. A ball landing at 2 m/s rolls at once where friction is
  // above (1 m/s / 3.5) / 2 m/s = 0.14; at 0.1 it goes on at 0.8 m/s in place of 0.71 m/s, 17 mm in 0.2 s
  const Accepted folder("[expect]\ntravel = \"0.27 m +- 0.13 m\"\n");
  folder.again();
  const double found = folder.report()["scenes"][0]["measures"][0]["found"];
  const std::string pinned = "[expect]\ntravel = \"" + std::to_string(found) + " m +- 1 mm\"\n";
  folder.write("scenes/ball.toml", kBall + pinned + kStill);
  EXPECT_EQ(folder.again().code, 0);
  folder.write("scenes/ball.toml", ball_with("friction = 0.5", "friction = 0.1") + pinned + kStill);
  const Result result = folder.again();
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.out, HasSubstr("measures changed, pictures did not"));
}

TEST(Snapshot, ASceneThatDoesNotLoadIsAnErrorAndItsBaselinesAreNoOrphans) {
  const Accepted folder;
  folder.write("scenes/ball.toml", ball_with("mass = \"2 kg\"", "mass = 2") + kStill);
  const Result result = folder.again();
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.out, HasSubstr("needs a unit"));
  EXPECT_THAT(result.out, testing::Not(HasSubstr("orphaned")));
  EXPECT_THAT(contents(folder / "snapshot-report/junit.xml"), HasSubstr("errors=\"1\""));
}

TEST(Snapshot, AnExpectationIsAValueWithATolerance) {
  const Folder folder;
  for (const char* wrong : {"\"12.3 m\"", "\"12.3 m +- 0.1 s\"", "\"12.3 +- 0.1 m\"", "\"12.3 m +- -0.1 m\""}) {
    folder.write("ball.toml", kBall + "[expect]\ntravel = " + wrong + "\n");
    const Result result = run(folder, {"check", "ball.toml"});
    EXPECT_EQ(result.code, 2) << wrong;
    EXPECT_THAT(result.out + result.err, HasSubstr("expect.travel")) << wrong;
  }
}
