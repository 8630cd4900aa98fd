// What lies still is left alone, and wakes before anything reaches it.
#include <gtest/gtest.h>

#include "tests/engine/experiment.h"

namespace {

using namespace engine;
using namespace engine::test;

/// A box of n = 15 at rest; another thrown towards it along the ground, which arrives after some two seconds.
Model box_in_the_way(bool sleep) {
  Model model = on_ground(6);
  model.settings.sleep = sleep;
  model.settings.record_interval = 0.05;
  const HyperEllipsoid box{{0.3, 0.2, 0.1}, 15};
  model.bodies = {solid(box, 20, {0, 0, 0.1}), solid(box, 20, {-14, 0, 0.1})};
  for (Body& body : model.bodies) body.surface.friction_ground = 0.3;
  model.bodies[1].V_WB.v = {10, 0, 0};
  return model;
}

TEST(Sleep, WakesBeforeItIsReachedAndTakesTheBlowAsIfAwake) {
  const Recording with = simulate(box_in_the_way(true)), without = simulate(box_in_the_way(false));
  const double reached = 13.4 / 10;  // [s] at the earliest
  ASSERT_LT(with.at(reached).bodies[0].X_WB.p.norm(), 0.11);
  for (const std::size_t b : {0, 1}) {
    const Vec3 end = with.snapshots.back().bodies[b].X_WB.p, awake = without.snapshots.back().bodies[b].X_WB.p;
    EXPECT_GT(awake.x(), b == 0 ? 0.3 : -1.0);
    EXPECT_LT((end - awake).norm(), 1e-4);  // the sleeper did not creep before the blow, as it does by micrometres awake
  }
}

TEST(Sleep, KeepsEverythingWhereItIs) {
  for (const bool sleep : {true, false}) {
    Model model = on_ground(10);
    model.settings.sleep = sleep;
    model.settings.record_interval = 1;
    model.bodies = {solid({{0.3, 0.2, 0.1}, 15}, 20, {0, 0, 0.1}), ball(0.1, 1, {3, 0, 0.1})};
    const Recording run = simulate(model);
    EXPECT_EQ(run.snapshots.back().contacts.empty(), sleep);  // nobody looked
    EXPECT_LT((run.snapshots.back().bodies[0].X_WB.p - Vec3(0, 0, 0.1)).norm(), 5e-5);
  }
}

TEST(Sleep, IsNotForWhatTheAuthorStillMoves) {
  // grip of the slope gives way after three seconds
  Model model = on_ground(5);
  model.settings.sleep = true;
  model.settings.gravity = {9.81 * std::sin(0.2), 0, -9.81 * std::cos(0.2)};
  model.bodies = {solid({{0.3, 0.2, 0.1}, 15}, 20, {0, 0, 0.1})};
  model.bodies[0].surface.friction_ground = Schedule({{0, 0.5}, {3, 0.5}, {3.001, 0.05}});
  const Recording run = simulate(model);
  const double a = 9.81 * (std::sin(0.2) - 0.05 * std::cos(0.2));
  EXPECT_NEAR(run.snapshots.back().bodies[0].X_WB.p.x(), 0.5 * a * 4, 0.02);
}

TEST(Sleep, OneWhoLiesByARestlessNeighbourDoesNotSleep) {
  // a ball rolls to and fro in reach of a box: both stay awake
  Model model = on_ground(4);
  model.settings.sleep = true;
  model.settings.record_interval = 1e-3;
  model.bodies = {solid({{0.3, 0.2, 0.1}, 15}, 20, {0, 0, 0.1}), ball(0.1, 1, {0.45, 0, 0.1})};
  model.bodies[1].V_WB = {Vec3(0.02, 0, 0), Vec3(0, 0.2, 0)};
  model.bodies[1].surface.friction_ground = 0.8;
  const Recording run = simulate(model);
  const Snapshot then = run.at(2.5);
  EXPECT_GT(then.bodies[1].V_WB.v.norm(), 0.01);
  EXPECT_TRUE(std::any_of(then.contacts.begin(), then.contacts.end(), [](auto& c) { return c.body_a == 0; }));
}

}  // namespace
