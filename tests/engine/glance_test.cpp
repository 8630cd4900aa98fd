// Collisions whose outcome hangs on what a rigid shell cannot tell.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/measure/glance.h"
#include "tests/engine/hand_made_runs.h"

namespace engine {
namespace {

constexpr int kOther = 1;

/// Two cars of 1000 kg, 1.6 m wide, nose to nose 4.2 m apart, the other 1.4 m to the left: at 20 m/s each they meet on 0.2 m, or
/// `beside` less, and exchange an impulse [N s] at 0.05 s.
struct Meeting {
  Model model;
  Recording run;

  Meeting(double beside, const Vec3& impulse, const Vec3& normal) {
    model.bodies.resize(2);
    for (Body& body : model.bodies) {
      body.mass = 1000;
      // a mirror above the slab of the bumpers is none of the width
      body.shape = MeshShape{box({-2, -0.8, -0.2}, {2, 0.8, 0.1}), Pose{}};
    }
    model.bodies[0].name = "a", model.bodies[0].vehicle = 0;
    model.bodies[kOther].name = "b", model.bodies[kOther].vehicle = 1;
    for (const int b : {0, kOther}) {
      Vehicle v;
      v.name = model.bodies[b].name;
      v.body = b;
      model.vehicles.push_back(v);
    }
    run.interval = 0.01;
    for (int i = 0; i < 20; ++i) {
      Snapshot s;
      s.time = 0.01 * i;
      s.bodies.own().resize(2);
      s.bodies.own()[0].X_WB.p = {0, 0, 0.5};
      s.bodies.own()[0].V_WB.v = {20, 0, 0};
      s.bodies.own()[kOther].X_WB.p = {4.2, 1.4 + beside, 0.5};
      s.bodies.own()[kOther].V_WB.v = {-20, 0, 0};
      run.snapshots.push_back(s);
    }
    ContactRecord c = push(0, kOther, kVehicles, impulse);
    c.normal = normal;
    c.point = {2.1, 0.7, 0.5};
    c.normal_impulse = -impulse.dot(normal) > 0 ? -impulse.dot(normal) : impulse.dot(normal);
    c.tangential_impulse = 0.3 * c.normal_impulse;
    c.friction_limit = 0.3 * c.normal_impulse;
    run.snapshots[5].contacts = {c};
  }
};

TEST(Glance, OverlapIsAcrossTheWayAtTheHeightOfTheTouch) {
  const Meeting m(0, {-9000, -3000, 0}, {-1, 0, 0});
  EXPECT_NEAR(overlap_across(m.model, m.run.snapshots[4], 0, kOther, {2.1, 0.7, 0.5}), 0.2, 1e-12);
  // one that comes from the side meets the whole flank's length
  Snapshot turned = m.run.snapshots[4];
  turned.bodies.own()[0].V_WB.v = {0, 20, 0};
  turned.bodies.own()[kOther].V_WB.v.setZero();
  EXPECT_NEAR(overlap_across(m.model, turned, 0, kOther, {2.1, 0.7, 0.5}), -0.2, 1e-12) << "4.2 m ahead of 4 m: it passes";
}

TEST(Glance, RigidCornersThatHookAreWarnedOf) {
  const auto told = [](double beside, const Vec3& impulse) {
    const Meeting m(beside, impulse, {-1, 0, 0});
    return doubtful_glances(m.model, m.run);
  };
  EXPECT_THAT(told(0, {-9000, -3000, 0}), testing::ElementsAre(testing::HasSubstr("a and b met on 20 cm of their widths")));
  EXPECT_THAT(told(0, {-1500, -3000, 0}), testing::IsEmpty()) << "they slide by";
  EXPECT_THAT(told(0, {-900, -300, 0}), testing::IsEmpty()) << "a scratch";
  EXPECT_THAT(told(-0.3, {-9000, -3000, 0}), testing::IsEmpty()) << "on half a metre both laws agree";
}

TEST(Glance, AClosingSpeedAlongASlantingNormalIsAPartOfTheRelativeOne) {
  const Vec3 diagonal(-0.5, -std::sqrt(0.75), 0);
  const Meeting m(-0.5, 9000 * diagonal, diagonal);
  const std::vector<Impact> impacts = impacts_of(m.model, m.run);
  ASSERT_EQ(impacts.size(), 1u);
  EXPECT_NEAR(impacts[0].relative_speed, 40, 1e-12);
  EXPECT_NEAR(impacts[0].closing_speed, 20, 1e-12);
}

/// A motorcycle is narrower than any corner: on all of its width it did not hook.
TEST(Glance, TwoWheelersAreNoHookedCorners) {
  Meeting m(0, {-9000, -3000, 0}, {-1, 0, 0});
  ASSERT_EQ(doubtful_glances(m.model, m.run).size(), 1u);
  m.model.vehicles[1].wheels.resize(2);
  m.model.vehicles[1].wheels[0].hub_B.x() = 1.4;
  EXPECT_THAT(doubtful_glances(m.model, m.run), testing::IsEmpty());
}

/// A graze at speed closes slowly too.
TEST(Glance, CarsThatGrazeAtSpeedDoNotMeetAtLowSpeed) {
  Meeting m(-0.5, {0, 2000, 0}, {0, 1, 0});
  for (Snapshot& s : m.run.snapshots) {
    s.bodies.own()[0].V_WB.v = {20, -2, 0};
    s.bodies.own()[kOther].V_WB.v = {-10, 0, 0};
  }
  const std::vector<Impact> impacts = impacts_of(m.model, m.run);
  ASSERT_EQ(impacts.size(), 1u);
  EXPECT_NEAR(impacts[0].closing_speed, 2, 1e-12);
  EXPECT_THAT(doubtful_glances(m.model, m.run), testing::IsEmpty());
}

TEST(Glance, CarsThatMeetSlowlyWithoutRestitutionAreWarnedOf) {
  const auto told = [](double speed, double restitution) {
    Meeting m(-0.5, {-2000, 0, 0}, {-1, 0, 0});
    for (Snapshot& s : m.run.snapshots)
      for (const int b : {0, kOther}) s.bodies.own()[b].V_WB.v = {b == 0 ? speed : 0, 0, 0};
    m.model.bodies[kOther].surface.restitution_body = restitution;
    for (Vehicle& v : m.model.vehicles) {
      v.wheels.resize(4);
      for (std::size_t i = 0; i < 4; ++i) v.wheels[i].hub_B.y() = i % 2 == 0 ? 0.7 : -0.7;
    }
    return doubtful_glances(m.model, m.run);
  };
  EXPECT_THAT(told(2.8, 0), testing::ElementsAre(testing::HasSubstr("a and b met at low speed without restitution")));
  EXPECT_THAT(told(2.8, 0.3), testing::IsEmpty());
  EXPECT_THAT(told(10, 0), testing::IsEmpty());
}

}  // namespace
}  // namespace engine
