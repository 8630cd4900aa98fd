// Which coefficients act: the smaller friction, the larger restitution, of the kind that fits the pair; and their tables over time.
#include <gtest/gtest.h>

#include "tests/engine/experiment.h"

namespace {

using namespace engine;
using namespace engine::test;

struct Kinds {
  double body, ground;
};

/// Height the first bounce of a ball dropped by 1 m would reach, on the ground or on a fixed ball.
double rebound(Kinds ball_e, Kinds other_e, bool on_body) {
  Model model = on_ground(0.55, 1e-3);
  model.settings.record_interval = 1e-3;
  model.bodies = {ball(0.1, 1, {0, 0, 1.1})};
  model.bodies[0].surface.restitution_body = ball_e.body;
  model.bodies[0].surface.restitution_ground = ball_e.ground;
  if (on_body) {
    model.ground.plane = false;
    model.bodies.push_back(ball(2, 1, {0, 0, -2}));
    model.bodies[1].fixed = true;
    model.bodies[1].surface.restitution_body = other_e.body;
    model.bodies[1].surface.restitution_ground = other_e.ground;
  } else {
    model.ground.surface.restitution_body = other_e.body;
    model.ground.surface.restitution_ground = other_e.ground;
  }
  const Recording run = simulate(model);
  const BodyState& end = run.snapshots.back().bodies[0];
  return end.X_WB.p.z() - 0.1 + end.V_WB.v.z() * end.V_WB.v.z() / (2 * kGravity);
}

TEST(Restitution, IsTheLargerOfTwoAndOfTheKindThatFits) {
  // dropped by 1 m it rises to e^2
  EXPECT_NEAR(rebound({0.9, 0.2}, {0.8, 0.5}, false), 0.25, 1e-3);
  EXPECT_NEAR(rebound({0.9, 0.5}, {0.8, 0.2}, false), 0.25, 1e-3);
  EXPECT_NEAR(rebound({0.2, 0.9}, {0.5, 0.8}, true), 0.25, 1e-3);
  EXPECT_NEAR(rebound({0.5, 0.9}, {0.2, 0.8}, true), 0.25, 1e-3);
}

/// Speed [m/s] lost in 0.5 s by a block that slides at 5 m/s, on the ground or on a fixed plate.
double speed_lost(Kinds block_mu, Kinds other_mu, bool on_body) {
  Model model = on_ground(0.5, 1e-3);
  model.bodies = {solid({{0.2, 0.2, 0.05}, 30}, 1, {0, 0, 0.05})};
  model.bodies[0].V_WB.v = {5, 0, 0};
  model.bodies[0].surface.friction_body = block_mu.body;
  model.bodies[0].surface.friction_ground = block_mu.ground;
  if (on_body) {
    model.ground.plane = false;
    Body plate;
    plate.name = "plate";
    plate.fixed = true;
    plate.shape = MeshShape{std::make_shared<TriangleMesh>(std::vector<Vec3>{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}},
                                                           std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}),
                            Pose{}};
    model.bodies.push_back(plate);
    model.bodies[1].surface.friction_body = other_mu.body;
    model.bodies[1].surface.friction_ground = other_mu.ground;
  } else {
    model.ground.surface.friction_body = other_mu.body;
    model.ground.surface.friction_ground = other_mu.ground;
  }
  return 5 - simulate(model).snapshots.back().bodies[0].V_WB.v.x();
}

TEST(Friction, IsTheSmallerOfTwoAndOfTheKindThatFits) {
  const double lost = 0.3 * kGravity * 0.5;
  EXPECT_NEAR(speed_lost({0.1, 0.3}, {0.1, 0.7}, false), lost, 1e-3 * lost);
  EXPECT_NEAR(speed_lost({0.1, 0.7}, {0.1, 0.3}, false), lost, 1e-3 * lost);
  EXPECT_NEAR(speed_lost({0.3, 0.1}, {0.7, 0.1}, true), lost, 1e-3 * lost);
  EXPECT_NEAR(speed_lost({0.7, 0.1}, {0.3, 0.1}, true), lost, 1e-3 * lost);
}

TEST(CollisionModels, DefaultAutoActsUnlessBothAskForKudlichSlibar) {
  using enum CollisionModel;
  EXPECT_EQ(model_between(default_auto, default_auto), default_auto);
  EXPECT_EQ(model_between(default_auto, kudlich_slibar), default_auto);
  EXPECT_EQ(model_between(kudlich_slibar, default_auto), default_auto);
  EXPECT_EQ(model_between(kudlich_slibar, kudlich_slibar), kudlich_slibar);
}

TEST(DynamicParameters, FrictionFollowsItsTable) {
  // mu falls from 0.6 to 0.2 over a second and stays: v = v0 - g int mu
  Model model = on_ground(1.5, 1e-3);
  model.bodies = {solid({{0.2, 0.2, 0.05}, 30}, 1, {0, 0, 0.05})};
  model.bodies[0].V_WB.v = {9, 0, 0};
  model.bodies[0].surface.friction_ground = Schedule({{0, 0.6}, {1, 0.2}});
  const Recording run = simulate(model);
  for (const double t : {0.5, 1.0, 1.5}) {
    const double integral = t < 1 ? 0.6 * t - 0.2 * t * t : 0.4 + 0.2 * (t - 1);
    // the coefficient is that of the start of each step: 0.4 /s * dt / 2 too high
    EXPECT_NEAR(run.at(t).bodies[0].V_WB.v.x(), 9 - kGravity * integral, kGravity * 0.4 * t * 1e-3);
  }
}

TEST(DynamicParameters, RestitutionIsThatOfTheMomentOfImpact) {
  Model model = on_ground(0.55, 1e-3);
  model.bodies = {ball(0.1, 1, {0, 0, 1.1})};
  // touches at 0.4515 s, half-way up the ramp from 0.2 to 0.8
  const double touch = std::sqrt(2 / kGravity);
  model.bodies[0].surface.restitution_ground = Schedule({{touch - 0.1, 0.2}, {touch + 0.1, 0.8}});
  const BodyState end = simulate(model).snapshots.back().bodies[0];
  EXPECT_NEAR(end.X_WB.p.z() - 0.1 + end.V_WB.v.z() * end.V_WB.v.z() / (2 * kGravity), 0.25, 5e-3);  // 3 /s times a step of 1 ms
}

TEST(DynamicParameters, StiffnessFollowsItsTable) {
  // a ball at rest sinks in by m g / S (resting law: no hysteresis at e = 1) as S doubles slowly
  Model model = on_ground(4, 1e-3);
  model.settings.contact_law = ContactLaw::compliant;
  model.settings.scheme = Scheme::rk4;
  model.bodies = {ball(0.1, 1, {0, 0, 0.1 - 0.9e-3})};
  model.ground.surface.stiffness = 1e13;
  model.bodies[0].surface.restitution_ground = 0.5;
  model.bodies[0].surface.stiffness = Schedule({{1, 10e3}, {2, 20e3}});
  const Recording run = simulate(model);
  auto depth = [&](double t) { return 0.1 - run.at(t).bodies[0].X_WB.p.z(); };
  // at rest the law stands between S and (1 + e)/2 S
  EXPECT_NEAR(depth(1) / depth(4), 2, 0.1);
}

}  // namespace
