// Cameras, shots, cards and panes on numbers: no GL.
#include <gtest/gtest.h>

#include <cmath>

#include "render/arrange.h"
#include "render/cameras.h"
#include "render/painter.h"
#include "render/video/story.h"
#include "tests/render/hand_made_stage.h"

namespace render {
namespace {

TEST(Camera, AnEyeSharesTheMotionOfItsBody) {
  Camera eye;
  eye.kind = CameraKind::eye;
  eye.follow = "car";
  eye.position = Vec3(1, 0, 0.5);  // ahead in the body, which faces +y of the world
  eye.target = Vec3(5, 0, 0.5);
  const View view = view_of(eye, made_run(), 0.5, 1);
  EXPECT_NEAR(view.eye[0], 1, kFloat);
  EXPECT_NEAR(view.eye[1], 1, kFloat);
  EXPECT_NEAR(view.eye[2], 1.5, kFloat);
  const Vec3 ahead = in_clip(view, Vec3(1, 9, 1.5));
  EXPECT_NEAR(ahead.x(), 0, kFloat);
  EXPECT_NEAR(ahead.y(), 0, kFloat);
}

TEST(Camera, APersonsEyeIsCarriedByTheHead) {
  Camera eye;
  eye.kind = CameraKind::eye;
  eye.follow = "ann";
  eye.position = Vec3(0.1, 0, 0);
  engine::Recording r = made_run();
  for (auto& s : r.snapshots) s.bodies.own()[2].X_WB.p = Vec3(0, 0, 1.6);
  EXPECT_NEAR(view_of(eye, r, 0.3, 1).eye[2], 1.6, kFloat);
}

TEST(Camera, APersonsEyeBacksOffFromWhatItIsPressedAgainst) {
  Stage s = made_stage();
  PersonActor ann;
  ann.name = "ann";
  ann.segments.push_back({});
  ann.segments[0].name = "head";
  ann.segments[0].body = 2;  // at the origin
  s.persons.push_back(ann);
  Camera eye;
  eye.name = "eye";
  eye.kind = CameraKind::eye;
  eye.follow = "ann";
  eye.position = {0.16, 0, 0.04};
  eye.target = {10, 0, 0.04};
  s.cameras.push_back(eye);
  const auto seen_from = [&](double wall) {
    s.meshes = {block(-1, {wall, -5, -5}, {wall + 1, 5, 5})};
    const Float3 at = arrange(s, made_run(), {0.3, "eye", 1}, 1.5).view.eye;
    return Vec3(at[0], at[1], at[2]);
  };
  EXPECT_LT((seen_from(2) - eye.position).norm(), kFloat);
  // 0.66 m are to be free from the middle of the head on: 0.36 m back, and as much up
  EXPECT_LT((seen_from(0.3) - Vec3(-0.20, 0, 0.40)).norm(), kFloat);
}

TEST(Camera, APathMeetsItsKnotsAndRunsSmoothlyBetween) {
  Camera moving;
  moving.kind = CameraKind::path;
  moving.path = {{0, Vec3(0, -5, 1), Vec3(0, 0, 1)}, {0.5, Vec3(2, -5, 1), Vec3(0, 0, 1)}, {1, Vec3(4, -4, 2), Vec3(0, 0, 1)}};
  const engine::Recording r = made_run();
  EXPECT_NEAR(view_of(moving, r, 0, 1).eye[0], 0, kFloat);
  EXPECT_NEAR(view_of(moving, r, 0.5, 1).eye[0], 2, kFloat);
  EXPECT_NEAR(view_of(moving, r, 2, 1).eye[2], 2, kFloat) << "beyond the last knot it stands";
  // no jump and no kink at the middle knot: the speeds on both sides agree to the curvature times the step
  constexpr double h = 0.01;
  const double before = view_of(moving, r, 0.5, 1).eye[0] - view_of(moving, r, 0.5 - h, 1).eye[0];
  const double after = view_of(moving, r, 0.5 + h, 1).eye[0] - view_of(moving, r, 0.5, 1).eye[0];
  EXPECT_NEAR(before, after, 0.05 * before + 10 * kFloat);
  EXPECT_GT(before, 0);
}

TEST(FilmOfShots, CardsFrameTheShotsAndTheClockIsThatOfTheWhole) {
  Stage s = made_stage();
  s.cards = {{"begin", {}, 0.2, false}, {"end", {}, 0.1, true}};
  s.shots = {{"side", 0, 1, 0.5, 0}, {"side", 0.4, 0.4, 0, 0.3}};
  const Film film(s, made_run().end_time(), 10);
  ASSERT_EQ(film.size(), 2 + 20 + 3 + 1);
  EXPECT_EQ(film[0].card, 0);
  EXPECT_EQ(film[2].card, -1);
  EXPECT_NEAR(film[3].time, 0.05, 1e-12) << "half speed";
  EXPECT_EQ(film[23].speed, 0);
  EXPECT_NEAR(film[23].time, 0.4, 1e-12) << "frozen";
  EXPECT_EQ(film[25].card, 1);
}

TEST(StoryOfAFilm, HasAChapterAShotAndASubtitleWhereAnEventIsPassed) {
  Stage s = made_stage();
  s.shots = {{"side", 0, 1, 1, 0}, {"side", 0, 1, 1, 0}};
  s.shots[0].title = "first look";
  const Story story = story_of(s, made_run(), Film(s, made_run().end_time(), 10), 10);
  ASSERT_EQ(story.chapters.size(), 2u);
  EXPECT_EQ(story.chapters[0].text, "first look");
  EXPECT_EQ(story.chapters[1].text, "side");
  EXPECT_DOUBLE_EQ(story.chapters[0].to, story.chapters[1].from);
  EXPECT_DOUBLE_EQ(story.chapters[1].to, 2.0);
  ASSERT_EQ(story.subtitles.size(), 2u) << "once a shot";
  EXPECT_NEAR(story.subtitles[0].from, 0.5, 0.1 + 1e-9) << "a frame at most from the event";
  EXPECT_LE(story.subtitles[0].to, story.subtitles[1].from);
  EXPECT_NE(story.subtitles[0].text.find("first contact: ann's hips and car, closing at 2.0 m/s"), std::string::npos);
}

TEST(StoryOfAFilm, ARiderLosesItsHoldAndBreaksNoJoint) {
  engine::Recording r;
  r.body_names = {"car", "bike", "ann/hips", "ann/left_foot", "bob/hips", "trailer"};
  r.events = {{0.1, "release", 2, 0, Vec3::Zero(), 0},
              {0.1, "collision", 0, 1, Vec3::Zero(), 13.9},
              {0.12, "joint_broken", 3, 1, Vec3::Zero(), 700},
              {0.13, "joint_broken", 2, 1, Vec3::Zero(), 5000},
              {0.13, "joint_broken", 4, 1, Vec3::Zero(), 900},
              {0.5, "joint_broken", 5, 0, Vec3::Zero(), 1e5},
              {2.0, "rest", 2, -1, Vec3::Zero(), 0}};
  const std::vector<Told> all = told(r);
  ASSERT_EQ(all.size(), 5u);
  EXPECT_EQ(all[0].text, "collision: car and bike, closing at 13.9 m/s");
  EXPECT_EQ(all[1].text, "ann loses hold of bike by 0.130 s: left foot, hips");
  EXPECT_EQ(all[2].text, "bob loses hold of bike: hips");
  EXPECT_EQ(all[3].text, "joint broken: trailer and car");
  EXPECT_EQ(all[4].text, "rest: ann");
}

TEST(StoryOfAFilm, OfMillionsOfFramesKnowsItsEvents) {
  Stage s = made_stage();
  s.shots = {{"side", 0, 1, 1, 0}, {"side", 0, 1, 1e-7, 0}};
  const Story story = story_of(s, made_run(), Film(s, made_run().end_time(), 30), 30);
  ASSERT_EQ(story.subtitles.size(), 2u);
  EXPECT_NEAR(story.subtitles[1].from, 1 + 0.5e7, 1.0 / 30);
  EXPECT_NEAR(story.chapters[1].to, 1 + 1e7, 1.0 / 30);
}

TEST(Panes, LieInTheFrameAndSplitOnesDoNotOverlap) {
  for (const auto& [w, h] : {std::pair{1280, 720}, {64, 64}, {7680, 4320}, {641, 361}})
    for (const Layout layout : {Layout::single, Layout::split, Layout::stacked, Layout::inset}) {
      const auto panes = panes_of(layout, w, h);
      for (const Pane& p : panes) {
        EXPECT_GE(p.x, 0);
        EXPECT_GE(p.y, 0);
        EXPECT_GT(p.width, 0);
        EXPECT_GT(p.height, 0);
        EXPECT_LE(p.x + p.width, w);
        EXPECT_LE(p.y + p.height, h);
      }
      if (layout == Layout::split) {
        EXPECT_LT(panes[0].x + panes[0].width, panes[1].x);
      }
      if (layout == Layout::stacked) {
        EXPECT_LT(panes[0].y + panes[0].height, panes[1].y);
      }
    }
}

}  // namespace
}  // namespace render
