// A run that goes wrong says when, with which body and in whose hands, and keeps what was right until then.
#include "engine/divergence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/simulate.h"

namespace engine {
namespace {

Body ball(const char* name, double x) {
  Body body;
  body.name = name;
  body.mass = 1;
  body.inertia_B = Mat3::Identity() * 0.01;
  body.shape = HyperEllipsoid{Vec3::Constant(0.1), 2};
  body.X_WB.p = {x, 0, 5};
  return body;
}

Model two_balls() {
  Model model;
  model.bodies = {ball("first", 0), ball("second", 2)};
  model.settings.duration = 0.1;
  return model;
}

/// Everything in a recording that a picture is made of.
bool all_finite(const Recording& recording) {
  for (const Snapshot& s : recording.snapshots)
    for (const BodyState& b : s.bodies)
      if (!b.X_WB.p.allFinite() || !b.X_WB.q.coeffs().allFinite() || !b.V_WB.v.allFinite() || !b.V_WB.w.allFinite()) return false;
  return true;
}

TEST(Divergence, OfANumberThatIsNoneEndsInItsStep) {
  Model model = two_balls();
  // the first step overflows
  model.settings.gravity = {0, 0, -1e308};
  model.ground.plane = false;
  model.bodies[0].fixed = true;
  const Recording recording = simulate(model);
  ASSERT_TRUE(recording.failure.has_value());
  EXPECT_EQ(recording.failure->body, "second");
  EXPECT_EQ(recording.failure->effect, "gravity");
  EXPECT_LE(recording.failure->time, model.settings.step * (1 + 1e-9));
  EXPECT_TRUE(all_finite(recording));
}

TEST(Divergence, OfASpeedEndsInTheStepThatReachesIt) {
  Model model = two_balls();
  model.settings.gravity = {0, 0, -50'000};
  model.bodies[0].fixed = true;
  model.ground.plane = false;
  const Recording recording = simulate(model);
  ASSERT_TRUE(recording.failure.has_value());
  EXPECT_EQ(recording.failure->body, "second");
  // v = g t passes 2000 m/s at 40 ms; the step after that is the first that can see it
  EXPECT_NEAR(recording.failure->time, 0.040, 1.1 * model.settings.step);
  EXPECT_TRUE(all_finite(recording));
  EXPECT_GT(recording.end_time(), 0.03) << "what was right is kept";
}

TEST(Divergence, OfEnergyOutOfNowhereIsNoticed) {
  const Model model = two_balls();
  const Plan plan = compile(model);
  const RunOptions options;
  World world(model, plan, options);
  State state;
  for (const Body& body : model.bodies) {
    state.X_WB.push_back(body.X_WB);
    state.V_WB.push_back({});
  }
  state.energy.dissipated.assign(plan.active.size(), 0);
  measure_energy(world, state);
  const auto look = [&] { return look_for_divergence(world, state, {}); };
  EXPECT_FALSE(look().has_value());
  // two kilogrammes may fall a metre: 19.6 J. 6 m/s of one of them are 18 J, 7 m/s are 24.5 J
  state.V_WB[1].v = {6, 0, 0};
  EXPECT_FALSE(look().has_value());
  state.V_WB[1].v = {7, 0, 0};
  ASSERT_TRUE(look().has_value());
  EXPECT_EQ(look()->body, "second");
  EXPECT_THAT(look()->message, testing::HasSubstr("more energy than it ever had"));
  // work that the books know of is no divergence
  state.energy.added = 10;
  EXPECT_FALSE(look().has_value());
}

TEST(LostBody, HasNumbersThatCannotBeReckonedWith) {
  const auto lost = [](auto change) {
    State state;
    state.X_WB.resize(2);
    state.V_WB.resize(2);
    change(state.X_WB[1], state.V_WB[1]);
    return lost_body(state);
  };
  EXPECT_EQ(lost([](Pose&, Twist&) {}), -1);
  EXPECT_EQ(lost([](Pose& X, Twist&) { X.p.y() = std::nan(""); }), 1);
  EXPECT_EQ(lost([](Pose& X, Twist&) { X.q.coeffs().setZero(); }), 1);
  EXPECT_EQ(lost([](Pose& X, Twist&) { X.q.x() = std::nan(""); }), 1);
  EXPECT_EQ(lost([](Pose&, Twist& V) { V.v.z() = 1e200; }), 1);
  EXPECT_EQ(lost([](Pose&, Twist& V) { V.w.x() = -INFINITY; }), 1);
}

}  // namespace
}  // namespace engine
