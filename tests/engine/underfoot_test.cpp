// Who walks, before anything touches: up and down with the ground, and off its edge.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/experiment.h"
#include "tests/engine/hand_made_runs.h"

namespace engine::test {
namespace {

constexpr double kPace = 1.5, kMiddle = 0.9, kStride = 0.7;  // [m/s], [m], [m]

/// Somebody of one part who walks along x from -1 m, feet at `height` [m].
Model walker(double height, double duration) {
  Model model = on_ground(duration);
  Body body = solid({{0.15, 0.2, kMiddle}, 2}, 70, {-1, 0, height + kMiddle});
  body.person = 0;
  body.V_WB.v.x() = kPace;
  model.bodies = {body};
  Person person;
  person.bodies = {0};
  person.head = person.hips = 0;
  model.persons = {person};
  return model;
}

const Vec3& place(const Snapshot& s) {
  return s.bodies[0].X_WB.p;
}

double residual(const Recording& run) {
  return std::abs(run.snapshots.back().energies.residual);
}

/// Over a kerb the height is the mean of the ground over a stride: a ramp 70 cm long.
TEST(Walker, GoesDownAndUpAKerbWithinAStride) {
  for (const double kerb : {0.15, -0.12}) {  // of the side it comes from
    Model model = walker(std::max(0.0, kerb), 1.4);
    model.ground.terrain = kerb > 0 ? box({-5, -5, -1}, {0, 5, kerb}) : box({0, -5, -1}, {5, 5, -kerb});
    const Recording run = simulate(model);
    for (const Snapshot& s : run.snapshots) {
      const double passed = std::clamp(place(s).x() / kStride + 0.5, 0.0, 1.0);
      const double expected = std::max(0.0, kerb) - kerb * passed;
      EXPECT_NEAR(place(s).z() - kMiddle, expected, 2e-3) << place(s).x() << ": a step of 1.5 mm";
    }
    EXPECT_NEAR(place(run.snapshots.back()).x(), -1 + 1.4 * kPace, 1e-9);
    EXPECT_TRUE(run.events.empty());
    EXPECT_LT(residual(run), 1e-6);
  }
}

/// The same of a pavement that is a fixed body: its edge under a foot is no touch. A bollard is.
TEST(Walker, StepsOffAFixedPavementAndIsReleasedByABollard) {
  for (const bool bollard : {false, true}) {
    Model model = walker(0.12, 1.4);
    Body fixed;
    fixed.name = "street";
    fixed.fixed = true;
    fixed.shape = MeshShape{box({-5, -5, -1}, {0, 5, 0.12}), {}};
    model.bodies.push_back(fixed);
    fixed.shape = MeshShape{box({0.8, -0.1, -1}, {0.9, 0.1, 1}), {}};
    if (bollard) model.bodies.push_back(fixed);
    const Recording run = simulate(model);
    const auto released = std::find_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "release"; });
    EXPECT_EQ(released != run.events.end(), bollard);
    if (bollard) {
      EXPECT_GT(released->time, 1.55 / kPace) << "as it comes to it";
    } else {
      EXPECT_NEAR(place(run.snapshots.back()).z() - kMiddle, 0, 2e-3);
    }
  }
}

TEST(Walker, KeepsToASlopeAndHasItsSpeed) {
  constexpr double kSlope = 0.1;
  Model model = walker(0, 2);
  model.ground.plane = false;
  const Vec3 far(20, 5, 2), near(-20, -5, -2);
  model.ground.terrain = std::make_shared<TriangleMesh>(
      std::vector<Vec3>{{near.x(), near.y(), near.z()}, {far.x(), near.y(), far.z()}, far, {near.x(), far.y(), near.z()}},
      std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
  const Recording run = simulate(model);
  const Snapshot &first = run.snapshots.front(), &last = run.snapshots.back();
  EXPECT_NEAR(place(last).z() - place(first).z(), kSlope * kPace * 2, 1e-9);
  EXPECT_NEAR(last.bodies[0].V_WB.v.z(), kSlope * kPace, 1e-12);
  EXPECT_LT(residual(run), 1e-6);
}

/// Off a quay it falls as a thrown body does, and not before its middle has passed the edge.
TEST(Walker, FallsOffAnEdge) {
  constexpr double kDrop = 3;
  Model model = walker(kDrop, 1.3);
  model.ground.terrain = box({-5, -5, 1}, {0, 5, kDrop});
  const Recording run = simulate(model);
  const auto released = std::find_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "release"; });
  ASSERT_NE(released, run.events.end());
  EXPECT_EQ(released->body_b, -1);
  EXPECT_NEAR(released->time, 1 / kPace, 2e-3);
  for (const Snapshot& s : run.snapshots) {
    const double since = s.time - released->time;
    const double z = kDrop + kMiddle - (since > 0 ? 0.5 * kGravity * since * since : 0);
    if (z < kMiddle + 0.05) break;
    EXPECT_NEAR(place(s).z(), z, 0.02) << s.time << ": its foot slips off the edge";
  }
}

TEST(Walker, IsStoppedByAWall) {
  Model model = walker(0, 1.3);
  model.ground.terrain = box({0, -5, -1}, {5, 5, 2});
  const Recording run = simulate(model);
  EXPECT_LT(place(run.snapshots.back()).x(), 0) << "not in it";
}

/// A deck that it rides on at the speed of the lorry is not what it stands on: it goes up and down with the road.
TEST(Walker, OnSomethingThatMovesStaysOnIt) {
  Model model = walker(1.2, 1.4);
  model.ground.terrain = box({-5, -5, -1}, {0, 5, 0.1});
  const Recording run = simulate(model);
  EXPECT_TRUE(run.events.empty());
  EXPECT_NEAR(place(run.snapshots.back()).z() - kMiddle, 1.1, 2e-3);
}

/// What somebody stands on drives off: they are free from the start, or from when it has a speed of its own, and come down.
TEST(Walker, IsReleasedByWhatMovesAwayUnderfoot) {
  // a hair above, so that the table does not press, and centimetres, as somebody is put on a roof
  for (const auto& [speed, above] : {std::pair(0.0, 1e-3), {2.0, 1e-3}, {0.0, 8e-3}, {0.2, 8e-3}, {0.2, 0.04}}) {
    Model model = walker(1 + above, 1.5);
    model.bodies[0].V_WB.v.setZero();
    Body table = solid({{0.5, 0.5, 0.5}, 30}, 100, {-1, 0, 0.5});
    table.name = "table";
    table.V_WB.v.x() = speed;
    model.bodies.push_back(table);
    const Recording run = simulate(model);
    const auto released = std::find_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "release"; });
    EXPECT_EQ(released != run.events.end(), speed > 0);
    if (speed > 0) {
      EXPECT_LT(released->time, 2e-3);
      EXPECT_EQ(released->body_b, 1);
    } else {
      EXPECT_EQ(place(run.snapshots.back()), model.bodies[0].X_WB.p);
    }
  }
}

/// Something of 15 kg joined to the walker, ahead of them.
Model pushing(const Vec3& velocity) {
  Model model = walker(0, 1);
  Body pram = ball(0.2, 15, {-0.3, 0, 0.5});
  pram.name = "pram";
  pram.V_WB.v = velocity;
  model.bodies.push_back(pram);
  model.joints.push_back(joint_at(model, JointKind::fixed, 0, 1, {-0.5, 0, 0.5}));
  return model;
}

TEST(Walker, TakesAlongWhatIsJoined) {
  const Recording run = simulate(pushing({kPace, 0, 0}));
  EXPECT_TRUE(run.events.empty()) << "their own pram is no touch";
  for (const Snapshot& s : run.snapshots) {
    EXPECT_NEAR(place(s).x(), -1 + kPace * s.time, 1e-9);
    EXPECT_NEAR(s.bodies[1].X_WB.p.x(), -0.3 + kPace * s.time, 1e-9);
  }
}

TEST(Walker, IsReleasedByATouchOfWhatIsJoined) {
  Model model = pushing({kPace, 0, 0});
  Body bollard = ball(0.1, 50, {0.5, 0, 0.5});
  bollard.fixed = true;
  model.bodies.push_back(bollard);
  const Recording run = simulate(model);
  const auto released = std::find_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "release"; });
  ASSERT_NE(released, run.events.end());
  EXPECT_NEAR(released->time, (0.8 - 0.3) / kPace, 2e-3);
}

/// A child in arms, which is touched first: who carries it is free with it.
TEST(Walker, IsReleasedWithThePersonTheyCarry) {
  Model model = pushing({kPace, 0, 0});
  model.bodies[1].person = 1;
  Person child;
  child.bodies = {1};
  child.head = child.hips = 1;
  model.persons.push_back(child);
  Body bollard = ball(0.1, 50, {0.5, 0, 0.5});
  bollard.fixed = true;
  model.bodies.push_back(bollard);
  const Recording run = simulate(model);
  EXPECT_EQ(std::count_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "release"; }), 2);
  EXPECT_LT(run.snapshots.back().bodies[0].V_WB.v.x(), 0.9 * kPace) << "its bollard stops them both";
}

TEST(Walker, DoesNotWaitWhereWhatIsJoinedPulls) {
  Model model = pushing({kPace, 0, 0});
  model.joints[0] = joint_at(model, JointKind::spherical, 0, 1, {-0.5, 0, 0.5});
  model.bodies[1].V_WB.w.z() = 3;  // about the joint, which the start makes consistent
  model.bodies[1].V_WB.v.y() = 3;
  const Recording run = simulate(model);
  ASSERT_FALSE(run.events.empty());
  EXPECT_EQ(run.events.front().kind, "release");
  EXPECT_EQ(run.events.front().time, 0);
  EXPECT_THAT(run.diagnostics.warnings, testing::Contains(testing::HasSubstr("pram, which is joined, pulls from the start")));
}

/// Who lies there from the start does not come down, on a hill as on a plane.
TEST(LyingPerson, HasNoLandingOfItsOwnAtTheStart) {
  for (const double height : {0.0, 1.0}) {
    Model model = walker(0, 0.3);
    model.persons[0].zero_condition = false;
    model.bodies[0] = solid({{0.9, 0.2, 0.15}, 4}, 70, {0, 0, height + 0.15});
    model.bodies[0].person = 0;
    if (height > 0) model.ground.terrain = box({-5, -5, -1}, {5, 5, height});
    const Recording run = simulate(model);
    EXPECT_TRUE(std::none_of(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "ground_contact"; }))
        << height;
  }
}

}  // namespace
}  // namespace engine::test
