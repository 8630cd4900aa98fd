// Report stills on numbers: what they show, and from where.
#include <gtest/gtest.h>

#include "render/figures/figures.h"
#include "tests/render/hand_made_stage.h"

namespace render {
namespace {

TEST(SiteDiagram, ShowsVehiclesWhereTheyMetAndNotWhereTheyBegan) {
  engine::Recording r = made_run();
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
    const std::vector<double> times = times_of_sheet(made_run(), job);
    ASSERT_EQ(times.size(), 9u);
    EXPECT_EQ(times.front(), struck ? 0.2 : 0.0);
    EXPECT_NEAR(times.back(), made_run().end_time(), 1e-12);
    for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GT(times[i], times[i - 1]);
  }
}

TEST(ContactSheet, LooksFromTheSideWhereNothingStandsBetween) {
  PersonFacts person;
  person.name = "car";  // runs along x
  person.bodies = {0};
  person.masses = {1};
  person.hit = 0.2;
  person.landed = 0.8;
  for (const double side : {-1.0, 1.0}) {
    Stage s = made_stage();
    s.meshes = {block(-1, {-9, 3 * side - 0.1, 0}, {9, 3 * side + 0.1, 4})};
    EXPECT_LT(camera_of_sheet(s, made_run(), person).position.y() * side, -5) << "a wall at y = " << 3 * side;
  }
}

TEST(StroboscopicStill, ShowsAVehicleInFullWhereItStruckAndClearWhereItEnds) {
  Stage s = made_stage();
  s.vehicles = {0};
  s.meshes = {block(0, {-1, -1, 0}, {1, 1, 1})};
  const std::vector<MeshActor> meshes = stage_of_stroboscope(s, made_run(), 0.2, 1).meshes;
  ASSERT_EQ(meshes.size(), 2u);
  for (const MeshActor& actor : meshes) EXPECT_EQ(actor.body, -1) << "stands still";
  EXPECT_NEAR(meshes[0].X_BM.p.x(), 0.4, 1e-12);
  EXPECT_TRUE(meshes[0].repaint.empty());
  EXPECT_NEAR(meshes[1].X_BM.p.x(), 2, 1e-12);
  ASSERT_EQ(meshes[1].repaint.size(), 1u);
  EXPECT_EQ(meshes[1].repaint[0].kind, MaterialKind::glass);
  s.persons.emplace_back().mount = 0;
  EXPECT_EQ(stage_of_stroboscope(s, made_run(), 0.2, 1).meshes[0].body, 0) << "what is ridden goes with its rider";
}

}  // namespace
}  // namespace render
