// Cameras, shots, cards, panes and overlays on numbers: no GL.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "render/arrange.h"
#include "render/cameras.h"
#include "render/figures/figures.h"
#include "render/matrix.h"
#include "render/overlays/overlay.h"
#include "render/painter.h"
#include "render/text/charts.h"
#include "render/text/labels.h"
#include "render/video/story.h"

namespace render {
namespace {

/// A body that runs along x at 2 m/s for a second, turned by 90 degrees to the left; one touch at 0.5 s.
engine::Recording run() {
  engine::Recording r;
  r.body_names = {"car", "ann/hips", "ann/head"};
  r.interval = 0.1;
  for (int i = 0; i <= 10; ++i) {
    engine::Snapshot s;
    s.time = 0.1 * i;
    s.bodies.own().resize(3);
    s.bodies.own()[0].X_WB.p = Vec3(2 * s.time, 0, 1);
    s.bodies.own()[0].X_WB.q = engine::Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()));
    s.bodies.own()[0].V_WB.v = Vec3(2, 0, 0);
    if (i == 5) {
      engine::ContactRecord c;
      c.shapes = {engine::ShapeKind::round, engine::ShapeKind::mesh};
      c.body_a = 1;
      c.body_b = 0;
      c.point = Vec3(1, 0.5, 1);
      c.impulse = Vec3(0, 10, 0);
      s.contacts.push_back(c);
    }
    s.energies.kinetic = 1000 - 100 * i;
    r.snapshots.push_back(s);
  }
  r.events.push_back({0.5, "first_contact", 1, 0, Vec3::Zero(), 2.0});
  return r;
}

Stage stage() {
  Stage s;
  s.title = "test";
  Camera side;
  side.name = "side";
  s.cameras.push_back(side);
  s.speeds.push_back({0, "car"});
  return s;
}

/// Where a world point falls, -1..1.
Vec3 in_clip(const View& view, const Vec3& p) {
  const Eigen::Vector4d c = from_gl(view.eye_to_clip) * from_gl(view.world_to_eye) * Eigen::Vector4d(p.x(), p.y(), p.z(), 1);
  return c.head<3>() / c.w();
}

/// A block to look at and to touch.
MeshActor block(int body, const Vec3& lower, const Vec3& upper) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k)
    corners.emplace_back(k & 1 ? upper.x() : lower.x(), k & 2 ? upper.y() : lower.y(), k & 4 ? upper.z() : lower.z());
  const std::vector<engine::Triangle> triangles{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  auto mesh = std::make_shared<Mesh>();
  mesh->materials.push_back({"paint", MaterialKind::paint});
  MeshActor actor;
  actor.body = body;
  actor.mesh = mesh;
  actor.solid = std::make_shared<engine::TriangleMesh>(corners, triangles);
  return actor;
}

constexpr double kFloat = 1e-5;  // matrices are handed over in single precision, lengths of some metres

TEST(Camera, AnEyeSharesTheMotionOfItsBody) {
  Camera eye;
  eye.kind = CameraKind::eye;
  eye.follow = "car";
  eye.position = Vec3(1, 0, 0.5);  // ahead in the body, which faces +y of the world
  eye.target = Vec3(5, 0, 0.5);
  const View view = view_of(eye, run(), 0.5, 1);
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
  engine::Recording r = run();
  for (auto& s : r.snapshots) s.bodies.own()[2].X_WB.p = Vec3(0, 0, 1.6);
  EXPECT_NEAR(view_of(eye, r, 0.3, 1).eye[2], 1.6, kFloat);
}

TEST(Camera, APersonsEyeBacksOffFromWhatItIsPressedAgainst) {
  Stage s = stage();
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
    const Float3 at = arrange(s, run(), {0.3, "eye", 1}, 1.5).view.eye;
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
  const engine::Recording r = run();
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
  Stage s = stage();
  s.cards = {{"begin", {}, 0.2, false}, {"end", {}, 0.1, true}};
  s.shots = {{"side", 0, 1, 0.5, 0}, {"side", 0.4, 0.4, 0, 0.3}};
  const Film film(s, run().end_time(), 10);
  ASSERT_EQ(film.size(), 2 + 20 + 3 + 1);
  EXPECT_EQ(film[0].card, 0);
  EXPECT_EQ(film[2].card, -1);
  EXPECT_NEAR(film[3].time, 0.05, 1e-12) << "half speed";
  EXPECT_EQ(film[23].speed, 0);
  EXPECT_NEAR(film[23].time, 0.4, 1e-12) << "frozen";
  EXPECT_EQ(film[25].card, 1);
}

TEST(StoryOfAFilm, HasAChapterAShotAndASubtitleWhereAnEventIsPassed) {
  Stage s = stage();
  s.shots = {{"side", 0, 1, 1, 0}, {"side", 0, 1, 1, 0}};
  s.shots[0].title = "first look";
  const Story story = story_of(s, run(), Film(s, run().end_time(), 10), 10);
  ASSERT_EQ(story.chapters.size(), 2u);
  EXPECT_EQ(story.chapters[0].text, "first look");
  EXPECT_EQ(story.chapters[1].text, "side");
  EXPECT_DOUBLE_EQ(story.chapters[0].to, story.chapters[1].from);
  EXPECT_DOUBLE_EQ(story.chapters[1].to, 2.0);
  ASSERT_EQ(story.subtitles.size(), 2u) << "once a shot";
  EXPECT_NEAR(story.subtitles[0].from, 0.5, 0.1 + 1e-9) << "a frame at most from the event";
  EXPECT_LE(story.subtitles[0].to, story.subtitles[1].from);
  EXPECT_NE(story.subtitles[0].text.find("first contact: ann's hips and car, 2.0 m/s"), std::string::npos);
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
  EXPECT_EQ(all[0].text, "collision: car and bike, 13.9 m/s");
  EXPECT_EQ(all[1].text, "ann loses hold of bike by 0.130 s: left foot, hips");
  EXPECT_EQ(all[2].text, "bob loses hold of bike: hips");
  EXPECT_EQ(all[3].text, "joint broken: trailer and car");
  EXPECT_EQ(all[4].text, "rest: ann");
}

TEST(SiteDiagram, ShowsVehiclesWhereTheyMetAndNotWhereTheyBegan) {
  engine::Recording r = run();
  FigureJob job;
  EXPECT_EQ(dashed_at(r, job), 0) << "nobody met";
  r.events.push_back({0.6, "collision", 0, 0, Vec3::Zero(), 5});
  EXPECT_EQ(dashed_at(r, job), 0.6);
  job.persons.resize(1);
  job.persons[0].hit = 0.5;
  EXPECT_EQ(dashed_at(r, job), 0.5) << "who is struck before the vehicles meet";
}

TEST(ContactSheet, ShowsNineInstantsAndNoneTwice) {
  FigureJob job;
  for (const bool struck : {false, true}) {
    if (struck) {
      job.persons.resize(1);
      job.persons[0].hit = 0.2;
      job.persons[0].landed = 0.7;
    }
    const std::vector<double> times = times_of_sheet(run(), job);
    ASSERT_EQ(times.size(), 9u);
    EXPECT_EQ(times.front(), struck ? 0.2 : 0.0);
    EXPECT_NEAR(times.back(), run().end_time(), 1e-12);
    for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GT(times[i], times[i - 1]);
  }
}

TEST(StoryOfAFilm, OfMillionsOfFramesKnowsItsEvents) {
  Stage s = stage();
  s.shots = {{"side", 0, 1, 1, 0}, {"side", 0, 1, 1e-7, 0}};
  const Story story = story_of(s, run(), Film(s, run().end_time(), 30), 30);
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

TEST(OverlayNumbers, VelocityArrowsAreAsLongAsTheSpeedBidsThem) {
  Stage s = stage();
  s.overlays.set("velocities");
  s.overlays.set("velocity_scale", 4);
  const DrawList list = arrange(s, run(), {0.5, "side", 1}, 1.5);
  ASSERT_EQ(list.arrows.size(), 1u);
  EXPECT_NEAR(list.arrows[0].to[0] - list.arrows[0].from[0], 2.0 / 4, kFloat);
}

TEST(OverlayNumbers, ADimensionCountsTheWayOfItsBody) {
  Stage s = stage();
  s.overlays.dimensions = {{"way", 0, 0.2}};
  const DrawList list = arrange(s, run(), {0.7, "side", 1}, 1.5);
  bool told = false;
  for (const LabelItem& label : list.labels) told |= label.lines[0] == "way 1.00 m";
  EXPECT_TRUE(told);
}

TEST(OverlayNumbers, AMarkStaysOnBothWhereTheyTouched) {
  Stage s = stage();
  s.overlays.set("contact_history");
  EXPECT_TRUE(arrange(s, run(), {0.4, "side", 1}, 1.5).lines.empty()) << "not yet touched";
  const DrawList list = arrange(s, run(), {1.0, "side", 1}, 1.5);
  ASSERT_EQ(list.lines.size(), 2u) << "one on the person, one on the car";
  // the car has moved on by a metre since and taken its mark along; marks stand 5 cm off towards the eye
  float farthest = 0;
  for (const LineItem& mark : list.lines) farthest = std::max(farthest, mark.points[0][0]);
  EXPECT_NEAR(farthest, 2, 0.05);
}

TEST(ContactSheet, LooksFromTheSideWhereNothingStandsBetween) {
  PersonFacts person;
  person.name = "car";  // runs along x
  person.bodies = {0};
  person.masses = {1};
  person.hit = 0.2;
  person.landed = 0.8;
  for (const double side : {-1.0, 1.0}) {
    Stage s = stage();
    s.meshes = {block(-1, {-9, 3 * side - 0.1, 0}, {9, 3 * side + 0.1, 4})};
    EXPECT_LT(camera_of_sheet(s, run(), person).position.y() * side, -5) << "a wall at y = " << 3 * side;
  }
}

TEST(StroboscopicStill, ShowsAVehicleInFullWhereItStruckAndClearWhereItEnds) {
  Stage s = stage();
  s.vehicles = {0};
  s.meshes = {block(0, {-1, -1, 0}, {1, 1, 1})};
  const std::vector<MeshActor> meshes = stage_of_stroboscope(s, run(), 0.2, 1).meshes;
  ASSERT_EQ(meshes.size(), 2u);
  for (const MeshActor& actor : meshes) EXPECT_EQ(actor.body, -1) << "stands still";
  EXPECT_NEAR(meshes[0].X_BM.p.x(), 0.4, 1e-12);
  EXPECT_TRUE(meshes[0].repaint.empty());
  EXPECT_NEAR(meshes[1].X_BM.p.x(), 2, 1e-12);
  ASSERT_EQ(meshes[1].repaint.size(), 1u);
  EXPECT_EQ(meshes[1].repaint[0].kind, MaterialKind::glass);
  s.persons.emplace_back().mount = 0;
  EXPECT_EQ(stage_of_stroboscope(s, run(), 0.2, 1).meshes[0].body, 0) << "what is ridden goes with its rider";
}

TEST(OverlayNumbers, AGhostRidesUntilItHasLeftTheSaddle) {
  engine::Recording r = run();
  for (engine::Snapshot& now : r.snapshots) {
    now.bodies.own()[1].X_WB.p = now.bodies[0].X_WB.p + Vec3(0, 0, now.time < 0.5 ? 0.6 : 1.2);
  }
  Stage s = stage();
  s.meshes = {block(0, {-1, -1, 0}, {1, 1, 1})};
  PersonActor& rider = s.persons.emplace_back();
  rider.mount = 0;
  rider.segments.push_back({});
  rider.segments[0].body = 1;
  s.overlays.set("ghost_interval", 0.2);
  const DrawList list = arrange(s, r, {1.0, "side", 1}, 1.5);
  EXPECT_EQ(list.ellipsoids.size(), 1u + 5u) << "0, 0.2, 0.4, 0.6, 0.8 s";
  ASSERT_EQ(list.meshes.size(), 1u + 3u) << "0, 0.2, 0.4 s";
  EXPECT_NEAR(list.meshes[3].model[12], 0.8, kFloat);
  EXPECT_NE(list.meshes[3].materials[0].kind, MaterialKind::paint) << "pale";
}

TEST(OverlayNumbers, GhostsAreWhereTheBodyWasAtEqualTimesOrWays) {
  Stage s = stage();
  EllipsoidActor ball;
  ball.body = 0;
  ball.shape = {Vec3::Constant(0.1), 2};
  s.ellipsoids.push_back(ball);
  s.overlays.set("ghost_interval", 0.3);
  EXPECT_EQ(arrange(s, run(), {1.0, "side", 1}, 1.5).ellipsoids.size(), 1u + 4u) << "0, 0.3, 0.6, 0.9 s";
  s.overlays.set("ghost_interval", 0);
  s.overlays.set("ghost_distance", 0.8);
  const DrawList list = arrange(s, run(), {1.0, "side", 1}, 1.5);
  ASSERT_EQ(list.ellipsoids.size(), 1u + 3u) << "0, 0.8, 1.6 m";
  EXPECT_NEAR(list.ellipsoids[2].model[12] - list.ellipsoids[1].model[12], 0.8, kFloat);
}

TEST(OverlayNumbers, AChartEndsNowAndItsAxesAreThoseOfTheWholeRun) {
  Stage s = stage();
  s.overlays.set("speed_chart"), s.overlays.set("energy_chart");
  const DrawList early = arrange(s, run(), {0.25, "side", 1}, 1.5), late = arrange(s, run(), {1, "side", 1}, 1.5);
  ASSERT_EQ(early.charts.size(), 2u);
  EXPECT_NEAR(early.charts[0].series[0].points.back()[0], 0.25, kFloat);
  EXPECT_NEAR(early.charts[0].series[0].points.back()[1], 7.2, 1e-4);
  EXPECT_EQ(early.charts[1].ceiling, late.charts[1].ceiling);
  EXPECT_GE(early.charts[1].ceiling, 1.0);
}

TEST(OverlayNumbers, APersonsSpeedIsThatOfItsCentreOfMass) {
  Stage s = stage();
  s.speeds = {{1, "ann", {{1, 30}, {2, 10}}}};
  s.overlays.set("velocities"), s.overlays.set("speed_chart");
  engine::Recording r = run();
  for (engine::Snapshot& now : r.snapshots) {
    now.bodies.own()[1].V_WB.v = Vec3(10, 0, 0);
    now.bodies.own()[2].V_WB.v = Vec3(2, 0, 0);
    now.bodies.own()[2].X_WB.p = Vec3(0, 0, 4);
  }
  const DrawList list = arrange(s, r, {0.5, "side", 1}, 1.5);
  // (30 * 10 + 10 * 2) / 40 = 8 m/s
  int told = 0;
  for (const LabelItem& label : list.labels)
    for (const std::string& line : label.lines) told += line == "ann 28.8 km/h";
  EXPECT_EQ(told, 2) << "caption and arrow";
  EXPECT_NEAR(list.charts[0].series[0].points.back()[1], 28.8, 1e-4);
  ASSERT_EQ(list.arrows.size(), 1u);
  EXPECT_NEAR(list.arrows[0].from[2], 1, kFloat) << "a quarter of the mass is 4 m up";
}

TEST(OverlayNumbers, AChartHasNoColourTwice) {
  Stage s = stage();
  s.overlays.set("speed_chart");
  s.speeds.clear();
  for (int i = 0; i < 11; ++i) s.speeds.push_back({0, "car " + std::to_string(i)});
  const ChartItem chart = arrange(s, run(), {0.5, "side", 1}, 1.5).charts.at(0);
  std::set<Float4> colours;
  for (const ChartItem::Series& series : chart.series) colours.insert(series.colour);
  EXPECT_EQ(colours.size(), 8u);
  EXPECT_EQ(chart.series.size(), 8u);
  EXPECT_EQ(chart.left_out, 3);
}

TEST(ChartKey, IsNeverTooSmallToRead) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
  cairo_t* c = cairo_create(surface);
  ChartItem chart;
  const auto add = [&chart](const std::string& name) { chart.series.push_back({name, {1, 1, 1, 1}, {}}); };
  add("car"), add("ann");
  ChartKey key = key_of(c, chart, 400, 1);
  EXPECT_EQ(key.letters, 15);
  EXPECT_FALSE(key.two_rows);
  EXPECT_EQ(key.more, "");
  for (int i = 0; i < 6; ++i) add("a pedestrian with a long name");
  chart.left_out = 2;
  key = key_of(c, chart, 400, 1);
  EXPECT_GE(key.letters, 8);
  EXPECT_GE(key.shown, 4u);
  EXPECT_LT(key.shown, 8u);
  EXPECT_TRUE(key.two_rows);
  EXPECT_EQ(key.more, "and " + std::to_string(10 - key.shown) + " more");
  cairo_destroy(c);
  cairo_surface_destroy(surface);
}

TEST(OverlayNumbers, AnImpulseGoesWithTheVehicleItStruck) {
  Stage s = stage();
  engine::Recording r = run();
  engine::ContactRecord c = r.snapshots[5].contacts.front();
  c.exchange = true;
  c.body_a = 0, c.body_b = 1;
  r.snapshots[5].contacts = {c};
  c.impulse *= 0.05;  // then they rub along each other
  c.point = Vec3(1.5, 0.5, 1);
  r.snapshots[6].contacts = {c};
  const DrawList list = arrange(s, r, {0.8, "side", 1}, 1.5);
  ASSERT_EQ(list.markers.size(), 1u) << "none of a minor one";
  EXPECT_EQ(list.arrows.size(), 2u);
  EXPECT_NEAR(list.markers[0].at[0], 1.6, kFloat) << "0.3 s at 2 m/s from 1 m";
}

TEST(OverlayNumbers, TheNumberOfAnImpulseIsNotWrittenOverTheCars) {
  engine::Recording r = run();
  r.snapshots[5].contacts[0].exchange = true;
  for (engine::Snapshot& now : r.snapshots) {  // a car that runs into the rear of another, along x
    now.bodies.own()[0].X_WB = {Vec3(-1.3, 0, 0.6), engine::Quat::Identity()};
    now.bodies.own()[1].X_WB = {Vec3(3.3, 0, 0.6), engine::Quat::Identity()};
  }
  Stage s = stage();
  Camera above = s.cameras[0];
  above.name = "above";
  above.kind = CameraKind::top;
  s.cameras[0].position = Vec3(1, -12, 1.5);  // from the side
  s.cameras[0].target = Vec3(1, 0, 0.8);
  s.cameras.push_back(above);
  for (const char* camera : {"side", "above"}) {
    const DrawList list = arrange(s, r, {0.6, camera, 1}, 1.5);
    const auto number = std::find_if(list.labels.begin(), list.labels.end(),
                                     [](const LabelItem& label) { return label.lines[0].starts_with("impulse"); });
    ASSERT_NE(number, list.labels.end());
    const Vec3 at = in_clip(list.view, Vec3(number->world[0], number->world[1], number->world[2]));
    // both cars together: 9.2 m long, 1.45 m high, 1.8 m wide
    Eigen::AlignedBox2d cars;
    for (const double x : {-3.6, 5.6})
      for (const double y : {-0.9, 0.9})
        for (const double z : {0.2, 1.45}) cars.extend(Eigen::Vector2d(in_clip(list.view, Vec3(x, y, z)).head<2>()));
    EXPECT_FALSE(cars.contains(at.head<2>())) << camera << " " << at.transpose();
  }
}

TEST(OverlayNumbers, AnEyeSeesNothingThatIsDrawnOver) {
  Stage s = stage();
  s.cameras[0].kind = CameraKind::eye;
  s.overlays.set("velocities"), s.overlays.set("contact_history");
  const DrawList list = arrange(s, run(), {1, "side", 1}, 1.5);
  EXPECT_TRUE(list.arrows.empty());
  EXPECT_TRUE(list.lines.empty());
  EXPECT_FALSE(list.labels.empty()) << "caption and disclaimer stay";
}

TEST(Labels, NeverCoverEachOtherNorLeaveTheFrame) {
  Stage s = stage();
  for (const char* key : {"velocities", "legend", "contact_history", "speed_chart", "energy_chart"}) s.overlays.set(key);
  s.overlays.dimensions = {
      {"way", 0, 0.2}, {"", -1, 0, Vec3(0, 0, 0), Vec3(1, 0, 0)}, {"", -1, 0, Vec3(0, 0, 0), Vec3(1, 0.01, 0)}};
  for (const auto& [w, h] : {std::pair{1280, 720}, {640, 640}, {320, 180}, {64, 64}}) {
    const DrawList list = arrange(s, run(), {0.7, "side", 1}, static_cast<double>(w) / h);
    std::vector<PanelBox> boxes = place_labels(list, w, h);
    for (const ChartItem& chart : list.charts) {
      const auto [x, y, cw, ch] = chart_box(chart, w, h);
      boxes.push_back({x, y, cw, ch, true});
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const PanelBox& a = boxes[i];
      if (!a.shown) continue;
      EXPECT_GE(a.x, 0);
      EXPECT_GE(a.y, 0);
      EXPECT_LE(a.x + a.width, w + 1e-9);
      EXPECT_LE(a.y + a.height, h + 1e-9);
      for (std::size_t k = 0; k < i; ++k) {
        const PanelBox& b = boxes[k];
        const bool apart = a.x >= b.x + b.width || b.x >= a.x + a.width || a.y >= b.y + b.height || b.y >= a.y + a.height;
        EXPECT_TRUE(!b.shown || apart) << w << "x" << h << " " << i << " " << k;
      }
    }
  }
}

TEST(ColourRamp, OnlyGetsLighter) {
  double last = 0;
  for (int i = 0; i <= 50; ++i) {
    const Float4 c = colour_of_share(i / 50.0);
    const double lightness = 0.2126 * std::pow(c[0], 2.2) + 0.7152 * std::pow(c[1], 2.2) + 0.0722 * std::pow(c[2], 2.2);
    EXPECT_GT(lightness, last) << i;
    last = lightness;
  }
}

TEST(Overlays, ThatAreNotShownAreNotComputed) {
  Stage bare = stage();
  bare.overlays.hide({"contacts", "forces", "caption", "disclaimer", "scale_bar"});
  const engine::Recording recording = run();
  const engine::Snapshot now = recording.at(0.5);
  const Moment moment{0.5, "side", 1};
  const Frame frame{bare, recording, now, moment, bare.cameras[0]};
  for (const Overlay* overlay : overlay_table()) EXPECT_FALSE(overlay->shown_in(frame)) << overlay->name;
  const DrawList list = arrange(bare, recording, moment, 1.78);
  EXPECT_EQ(list.lines.size() + list.arrows.size() + list.markers.size() + list.labels.size() + list.charts.size(), 0U);
}

}  // namespace
}  // namespace render
