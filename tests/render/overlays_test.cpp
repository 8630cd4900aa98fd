// Overlays on numbers: no GL.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "render/arrange.h"
#include "render/cameras.h"
#include "render/overlays/overlay.h"
#include "render/text/charts.h"
#include "render/text/labels.h"
#include "tests/render/hand_made_stage.h"

namespace render {
namespace {

TEST(OverlayNumbers, VelocityArrowsAreAsLongAsTheSpeedBidsThem) {
  Stage s = made_stage();
  s.overlays.set("velocities");
  s.overlays.set("velocity_scale", 4);
  const DrawList list = arrange(s, made_run(), {0.5, "side", 1}, 1.5);
  ASSERT_EQ(list.arrows.size(), 1u);
  EXPECT_NEAR(list.arrows[0].to[0] - list.arrows[0].from[0], 2.0 / 4, kFloat);
}

TEST(OverlayNumbers, ADimensionCountsTheWayOfItsBody) {
  Stage s = made_stage();
  s.overlays.dimensions = {{"way", 0, 0.2}};
  const DrawList list = arrange(s, made_run(), {0.7, "side", 1}, 1.5);
  bool told = false;
  for (const LabelItem& label : list.labels) told |= label.lines[0] == "way 1.00 m";
  EXPECT_TRUE(told);
}

/// A person's throw is that of the centre of mass: half of its mass stays where it is here.
TEST(OverlayNumbers, ADimensionOfAPersonIsThatOfTheCentreOfMass) {
  Stage s = made_stage();
  s.overlays.dimensions = {{"way", 0, 0.2}};
  s.speeds = {{0, "person", {{0, 1.0}, {1, 1.0}}}};
  engine::Recording r = made_run();
  for (engine::Snapshot& now : r.snapshots) now.bodies.own()[1].X_WB.p.setZero();
  const DrawList list = arrange(s, r, {0.7, "side", 1}, 1.5);
  bool told = false;
  for (const LabelItem& label : list.labels) told |= label.lines[0] == "way 0.50 m";
  EXPECT_TRUE(told);
}

TEST(OverlayNumbers, AMarkStaysOnBothWhereTheyTouched) {
  Stage s = made_stage();
  s.overlays.set("contact_history");
  EXPECT_TRUE(arrange(s, made_run(), {0.4, "side", 1}, 1.5).lines.empty()) << "not yet touched";
  const DrawList list = arrange(s, made_run(), {1.0, "side", 1}, 1.5);
  ASSERT_EQ(list.lines.size(), 2u) << "one on the person, one on the car";
  // the car has moved on by a metre since and taken its mark along; marks stand 5 cm off towards the eye
  float farthest = 0;
  for (const LineItem& mark : list.lines) farthest = std::max(farthest, mark.points[0][0]);
  EXPECT_NEAR(farthest, 2, 0.05);
}

TEST(OverlayNumbers, AGhostRidesUntilItHasLeftTheSaddle) {
  engine::Recording r = made_run();
  for (engine::Snapshot& now : r.snapshots) {
    now.bodies.own()[1].X_WB.p = now.bodies[0].X_WB.p + Vec3(0, 0, now.time < 0.5 ? 0.6 : 1.2);
  }
  Stage s = made_stage();
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
  Stage s = made_stage();
  EllipsoidActor ball;
  ball.body = 0;
  ball.shape = {Vec3::Constant(0.1), 2};
  s.ellipsoids.push_back(ball);
  s.overlays.set("ghost_interval", 0.3);
  EXPECT_EQ(arrange(s, made_run(), {1.0, "side", 1}, 1.5).ellipsoids.size(), 1u + 4u) << "0, 0.3, 0.6, 0.9 s";
  s.overlays.set("ghost_interval", 0);
  s.overlays.set("ghost_distance", 0.8);
  const DrawList list = arrange(s, made_run(), {1.0, "side", 1}, 1.5);
  ASSERT_EQ(list.ellipsoids.size(), 1u + 3u) << "0, 0.8, 1.6 m";
  EXPECT_NEAR(list.ellipsoids[2].model[12] - list.ellipsoids[1].model[12], 0.8, kFloat);
}

TEST(OverlayNumbers, AChartEndsNowAndItsAxesAreThoseOfTheWholeRun) {
  Stage s = made_stage();
  s.overlays.set("speed_chart"), s.overlays.set("energy_chart");
  const DrawList early = arrange(s, made_run(), {0.25, "side", 1}, 1.5), late = arrange(s, made_run(), {1, "side", 1}, 1.5);
  ASSERT_EQ(early.charts.size(), 2u);
  EXPECT_NEAR(early.charts[0].series[0].points.back()[0], 0.25, kFloat);
  EXPECT_NEAR(early.charts[0].series[0].points.back()[1], 7.2, 1e-4);
  EXPECT_EQ(early.charts[1].ceiling, late.charts[1].ceiling);
  EXPECT_GE(early.charts[1].ceiling, 1.0);
}

TEST(OverlayNumbers, APersonsSpeedIsThatOfItsCentreOfMass) {
  Stage s = made_stage();
  s.speeds = {{1, "ann", {{1, 30}, {2, 10}}}};
  s.overlays.set("velocities"), s.overlays.set("speed_chart");
  engine::Recording r = made_run();
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
  Stage s = made_stage();
  s.overlays.set("speed_chart");
  s.speeds.clear();
  for (int i = 0; i < 11; ++i) s.speeds.push_back({0, "car " + std::to_string(i)});
  const ChartItem chart = arrange(s, made_run(), {0.5, "side", 1}, 1.5).charts.at(0);
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
  Stage s = made_stage();
  engine::Recording r = made_run();
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
  engine::Recording r = made_run();
  r.snapshots[5].contacts[0].exchange = true;
  for (engine::Snapshot& now : r.snapshots) {  // a car that runs into the rear of another, along x
    now.bodies.own()[0].X_WB = {Vec3(-1.3, 0, 0.6), engine::Quat::Identity()};
    now.bodies.own()[1].X_WB = {Vec3(3.3, 0, 0.6), engine::Quat::Identity()};
  }
  Stage s = made_stage();
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
  Stage s = made_stage();
  s.cameras[0].kind = CameraKind::eye;
  s.overlays.set("velocities"), s.overlays.set("contact_history");
  const DrawList list = arrange(s, made_run(), {1, "side", 1}, 1.5);
  EXPECT_TRUE(list.arrows.empty());
  EXPECT_TRUE(list.lines.empty());
  EXPECT_FALSE(list.labels.empty()) << "caption and disclaimer stay";
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
  Stage bare = made_stage();
  bare.overlays.hide({"contacts", "forces", "caption", "disclaimer", "scale_bar"});
  const engine::Recording recording = made_run();
  const engine::Snapshot now = recording.at(0.5);
  const Moment moment{0.5, "side", 1};
  const Frame frame{bare, recording, now, moment, bare.cameras[0]};
  for (const Overlay* overlay : overlay_table()) EXPECT_FALSE(overlay->shown_in(frame)) << overlay->name;
  const DrawList list = arrange(bare, recording, moment, 1.78);
  EXPECT_EQ(list.lines.size() + list.arrows.size() + list.markers.size() + list.labels.size() + list.charts.size(), 0U);
}

}  // namespace
}  // namespace render
