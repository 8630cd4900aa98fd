// How soon two things can touch: proved before a run, held against runs in which nothing is left out.
#include "engine/effects/reach.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "engine/plan.h"
#include "engine/simulate.h"
#include "tests/engine/experiment.h"

namespace reach_tests {
namespace {

using namespace engine;

Body ball(const Vec3& at, const Vec3& velocity) {
  Body body = test::ball(0.1, 1, at);
  body.V_WB.v = velocity;
  return body;
}

Model in_space(std::vector<Body> bodies, double duration) {
  Model model;
  model.bodies = std::move(bodies);
  model.ground.plane = false;
  model.settings.gravity.setZero();
  model.settings.duration = duration;
  return model;
}

bool is_on(const Model& model, const std::string& effect) {
  return compile(model).has(effect);
}

Model with_all_forced_on(Model model) {
  for (const PlanLine& line : compile(model).lines) model.settings.effects[line.effect] = Force::on;
  return model;
}

TEST(Reach, LeavesOutWhatCannotMeetInTimeAndComputesWhatCan) {
  // 100 m at 10 m/s
  const std::vector<Body> bodies = {ball({0, 0, 0}, {10, 0, 0}), ball({100, 0, 0}, {0, 0, 0})};
  EXPECT_FALSE(is_on(in_space(bodies, 8), "body_contact"));
  EXPECT_TRUE(is_on(in_space(bodies, 11), "body_contact"));
  const Reach reach = reach_of(in_space(bodies, 11));
  EXPECT_LT(reach.first_touch, 9.98);
  EXPECT_GT(reach.first_touch, 9);  // 5 % and 5 cm to spare
  EXPECT_EQ(reach_of(in_space(bodies, 8)).first_touch, std::numeric_limits<double>::infinity());
}

TEST(Reach, CountsTheFallFromAHeight) {
  // over level ground the height is worth sqrt(2 g h) = 14 m/s
  std::vector<Body> bodies = {ball({0, 0, 10}, {0, 0, 0}), ball({30, 0, 0.1}, {0, 0, 0})};
  Model model = in_space(bodies, 1);
  model.settings.gravity.z() = -kGravity;
  model.ground.plane = true;
  EXPECT_FALSE(is_on(model, "body_contact"));
  model.settings.duration = 4;
  EXPECT_TRUE(is_on(model, "body_contact"));
}

TEST(Reach, IsNoBoundOnWhatASpringOrTheWindMayDrive) {
  Model model = in_space({ball({0, 0, 0}, {0, 0, 0}), ball({100, 0, 0}, {0, 0, 0})}, 1);
  EXPECT_FALSE(is_on(model, "body_contact"));
  Model windy = model;
  windy.inputs["air.density"] = {1.2, 0, 0};
  windy.inputs["air.wind"] = {30, 0, 0};
  windy.inputs["air.drag"] = {1.2, 0, 0};
  EXPECT_TRUE(is_on(windy, "body_contact"));
  Model sprung = model;
  Joint hinge;
  hinge.kind = JointKind::revolute;
  hinge.child = 0;
  hinge.angles[1].stiffness = 1e4;
  sprung.joints.push_back(hinge);
  EXPECT_TRUE(is_on(sprung, "body_contact"));
}

/// Balls of random places and speeds over level ground, on a slope or in space; some touch early, some late, some never.
Model random_balls(std::mt19937_64& engine) {
  const auto draw = [&engine](double low, double high) { return std::uniform_real_distribution<>(low, high)(engine); };
  std::vector<Body> bodies;
  const int count = 2 + static_cast<int>(draw(0, 3));
  for (int i = 0; i < count; ++i) {
    bodies.push_back(ball({6 * i + draw(0, 5), draw(-0.1, 0.1), draw(0.1, 0.3)}, {draw(-20, 20), draw(-0.3, 0.3), draw(-1, 1)}));
    bodies.back().V_WB.w = {draw(-100, 100), draw(-100, 100), draw(-100, 100)};
    bodies.back().surface.restitution_ground = draw(0, 1);
    bodies.back().surface.restitution_body = draw(0, 1);
    bodies.back().surface.friction_ground = draw(0, 1);
  }
  Model model = in_space(bodies, draw(0.05, 0.6));
  const int place = static_cast<int>(draw(0, 3));
  model.ground.plane = place < 2;
  if (place < 2) model.settings.gravity.z() = -kGravity;
  if (place == 1) model.settings.gravity.x() = draw(0, 6);
  model.settings.stop_at_rest = false;
  return model;
}

TEST(Reach, NeverComesAfterTheTouchOfARandomScene) {
  std::mt19937_64 engine(26);
  int proved = 0, touched = 0;
  for (int k = 0; k < 120; ++k) {
    const Model model = random_balls(engine);
    const Reach reach = reach_of(model);
    const Recording run = simulate(with_all_forced_on(model));
    EXPECT_EQ(hash(run), hash(simulate(model))) << k;
    for (const PlanLine& line : run.plan) {
      if (line.effect != "body_contact" || line.acted.first < 0) continue;
      ++touched;
      EXPECT_GE(line.acted.first, reach.first_touch) << k;
    }
    proved += std::isinf(reach.first_touch);
  }
  EXPECT_GT(proved, 10);
  EXPECT_GT(touched, 10);
}

/// Two who wait, their trunks and arms 0.2 m apart, and a ball that rolls up to them.
Model waiting_pair(const Vec3& walk, double duration) {
  Model model = in_space({ball({20, 0, 0}, {-5, 0, 0})}, duration);
  for (int p = 0; p < 2; ++p) {
    Person person;
    person.name = p == 0 ? "left" : "right";
    for (int k = 0; k < 2; ++k) {  // the trunk, and an arm that hangs
      Body body = ball({0, (p == 0 ? 1 : -1) * (0.2 + 0.5 * (1 - k)), -0.5 * k}, (p == 0 ? -1 : 1) * walk);
      body.person = p;
      person.bodies.push_back(static_cast<int>(model.bodies.size()));
      model.bodies.push_back(body);
    }
    Joint shoulder;
    shoulder.kind = JointKind::spherical;
    shoulder.parent = person.bodies[0];
    shoulder.child = person.bodies[1];
    shoulder.X_PF.p = {0, 0, -0.25};
    shoulder.X_CF.p = shoulder.X_PF.p + model.bodies[shoulder.parent].X_WB.p - model.bodies[shoulder.child].X_WB.p;
    model.joints.push_back(shoulder);
    model.persons.push_back(person);
  }
  return model;
}

TEST(Reach, TwoWhoWaitSideBySideAreTouchedFirstByWhatComes) {
  // 20 m, less half a metre of bodies, at 5 m/s: no sooner than in 3.7 s, though the two stand a hand's breadth apart
  const Model model = waiting_pair({0, 0, 0}, 5);
  const Reach reach = reach_of(model);
  EXPECT_GT(reach.first_touch, 3.5);
  EXPECT_LT(reach.first_touch, 4);
  EXPECT_EQ(hash(simulate(with_all_forced_on(model))), hash(simulate(model)));
  EXPECT_FALSE(is_on(waiting_pair({0, 0, 0}, 3), "body_contact"));
}

TEST(Reach, TwoWhoWalkUpToEachOtherTouchBeforeWhatComes) {
  // 0.2 m less the spare, at 0.1 m/s
  const Reach reach = reach_of(waiting_pair({0, 0.05, 0}, 5));
  EXPECT_GT(reach.first_touch, 1.4);
  EXPECT_LT(reach.first_touch, 2);
  const Model model = waiting_pair({0, 0.05, 0}, 3);
  EXPECT_TRUE(is_on(model, "body_contact"));
  EXPECT_EQ(hash(simulate(with_all_forced_on(model))), hash(simulate(model)));
}

TEST(Reach, TwoWhoWaitWithinTheSpareMayTouchAtOnce) {
  Model model = waiting_pair({0, 0, 0}, 5);
  for (const int b : model.persons[1].bodies) model.bodies[b].X_WB.p.y() += 0.16;
  EXPECT_EQ(reach_of(model).first_touch, 0);
}

TEST(Reach, GravityAndStillAirAreNeedlessWhileAllWait) {
  Model model = waiting_pair({0, 0.01, 0}, 0.5);
  model.bodies[0].fixed = true;
  model.bodies[0].V_WB.v.setZero();
  model.settings.gravity.z() = -kGravity;
  model.ground.plane = true;
  for (const char* effect : {"gravity", "air_drag", "joint_limits", "ground_contact"}) EXPECT_FALSE(is_on(model, effect)) << effect;
  EXPECT_EQ(hash(simulate(with_all_forced_on(model))), hash(simulate(model)));
  // the push of the wind on who waits is left out, which the line of the effect must go on to say
  Model windy = model;
  windy.inputs["air.density"] = {1.2, 0, 0};
  windy.inputs["air.wind"] = {30, 0, 0};
  windy.inputs["air.drag"] = {1.2, 0, 0};
  EXPECT_TRUE(is_on(windy, "air_drag"));
  // a ball that falls somewhere is reason enough for both
  Model falling = waiting_pair({0, 0.01, 0}, 0.5);
  falling.settings.gravity.z() = -kGravity;
  EXPECT_TRUE(is_on(falling, "gravity"));
  EXPECT_TRUE(is_on(falling, "air_drag"));
}

TEST(Reach, ARunTellsWhenAnEffectActed) {
  // dropped from 1 m with e = 0.5: the first touch after sqrt(2 h/g) = 0.452 s
  Model model = in_space({ball({0, 0, 1.1}, {0, 0, 0})}, 0.5);
  model.ground.plane = true;
  model.settings.gravity.z() = -kGravity;
  model.bodies[0].surface.restitution_ground = 0.5;
  for (const PlanLine& line : simulate(model).plan) {
    if (line.effect != "ground_contact") continue;
    EXPECT_TRUE(line.acted.told);
    EXPECT_NEAR(line.acted.first, std::sqrt(2 / kGravity), 1e-5);
    EXPECT_LE(line.acted.in_reach, line.acted.first);
  }
  model.settings.duration = 0.3;
  for (const PlanLine& line : simulate(model).plan) {
    if (line.effect == "ground_contact") {
      EXPECT_LT(line.acted.in_reach, 0);
    }
  }
}

}  // namespace
}  // namespace reach_tests
