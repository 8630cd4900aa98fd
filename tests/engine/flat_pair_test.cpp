// Boxes on boxes: a side that lies on another touches at the corners of what they share.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/geometry/hyper_ellipsoid_faces.h"
#include "engine/geometry/hyper_ellipsoid_pair.h"
#include "engine/geometry/hyper_ellipsoid_plane.h"
#include "tests/engine/experiment.h"

namespace engine::test {
namespace {

const HyperEllipsoid kBox{Vec3(0.2, 0.2, 0.1), 20};

/// Boxes of 10 kg, each where it is put.
Model boxes(const std::vector<Vec3>& places, double duration, double step) {
  Model model = on_ground(duration, step);
  for (const Vec3& place : places) {
    model.bodies.push_back(solid(kBox, 10, place));
    model.bodies.back().surface.friction_body = 0.6;
  }
  return model;
}

std::vector<ContactRecord> between(const Recording& run, int a, int b) {
  std::vector<ContactRecord> out;
  for (const ContactRecord& c : run.snapshots.back().contacts)
    if (c.body_a == a && c.body_b == b) out.push_back(c);
  return out;
}

class Tower : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Steps, Tower, testing::Values(4e-3, 1e-3));

TEST_P(Tower, OfTenBoxesStands) {
  std::vector<Vec3> places;
  for (int i = 0; i < 10; ++i) places.emplace_back(i % 3 == 1 ? 0.03 : 0, i % 4 == 2 ? 0.02 : 0, 0.1 + 0.2 * i);
  const Recording run = simulate(boxes(places, 2, GetParam()));
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_LT((run.snapshots.back().bodies[i].X_WB.p - places[i]).norm(), 1e-4 * static_cast<double>(i + 1)) << i;
  EXPECT_LT(run.diagnostics.max_penetration, 1e-4);
}

/// It used to rock on the deepest point of its lowest box for ever, and every step found its impulses anew by some sweeps and eight
/// steps of Newton.
TEST_P(Tower, ComesToRestSoThatItsImpulsesServeTheNextStep) {
  std::vector<Vec3> places;
  for (int i = 0; i < 10; ++i) places.emplace_back(0, 0, 0.1 + 0.2 * i);
  for (const double tolerance : {1e-5, 1e-6, 1e-7}) {
    Model model = boxes(places, 2, GetParam());
    model.settings.solver_tolerance = tolerance;
    const Recording run = simulate(model);
    double fastest = 0;  // [rad/s] at any time
    for (const Snapshot& snapshot : run.snapshots)
      for (const BodyState& body : snapshot.bodies)
        if (snapshot.time > 0.5) fastest = std::max(fastest, body.V_WB.w.norm());
    // nothing but what the solver leaves turns a box, in proportion to its tolerance [m/s]: a few hundredths of it over a metre.
    // It rocked at 5e-4 rad/s
    EXPECT_LT(fastest, 0.03 * tolerance);
    EXPECT_LT(run.diagnostics.contact_sweeps, 3 * run.steps / 2);
  }
}

/// It was 500 times dearer at 4 ms than at 1 ms, with boxes 71 mm in each other. Steps and tolerances of the four profiles.
TEST(TowerOfTen, AsksForNoMoreWorkAtALongerStep) {
  std::vector<Vec3> places;
  for (int i = 0; i < 10; ++i) places.emplace_back(0, 0, 0.1 + 0.2 * i);
  long least = 0;
  for (const auto& [step, tolerance] : {std::pair{4e-3, 1e-4}, {1e-3, 1e-5}, {0.25e-3, 1e-6}, {0.0625e-3, 1e-7}}) {
    Model model = boxes(places, 0.5, step);
    model.settings.solver_tolerance = tolerance;
    const Recording run = simulate(model);
    const Diagnostics& d = run.diagnostics;
    const long work = run.steps + d.substeps + d.contact_sweeps + d.newton_steps;
    EXPECT_GT(work, least) << step;
    EXPECT_LT(d.max_penetration, 1e-4) << step;
    EXPECT_LT(d.contact_sweeps, 3 * run.steps / 2) << step << ": at rest the impulses of a step serve the next";
    least = work;
  }
}

TEST_P(Tower, RestsWithItsWeightSpreadOverTheCornersAsItsLeverSays) {
  const Vec3 aside(0.06, 0.03, 0.2);
  const Recording run = simulate(boxes({Vec3(0, 0, 0.1), Vec3(0, 0, 0.1) + aside}, 1, GetParam()));
  const std::vector<ContactRecord> corners = between(run, 0, 1);
  ASSERT_EQ(corners.size(), 4u);
  double weight = 0;
  Vec3 moment = Vec3::Zero();
  for (const ContactRecord& c : corners) {
    EXPECT_GT(c.normal_force, 0.02 * 10 * kGravity) << "each corner carries some of it";
    weight += c.normal_force;
    moment += c.normal_force * c.point;
  }
  // in balance: the load of the upper box, acting under its centre. The solver's tolerance of 1e-5 m/s is 1e-3 of g dt at 1 ms
  EXPECT_NEAR(weight, 10 * kGravity, 2e-3 * 10 * kGravity);
  EXPECT_NEAR(moment.x() / weight, aside.x(), 1e-3);
  EXPECT_NEAR(moment.y() / weight, aside.y(), 1e-3);
}

TEST(Faces, CarryThickBodiesOnFourCornersOnly) {
  for (const double exponent : {8.0, 20.0, 30.0})
    for (const double half_depth : {0.02, 0.1, 0.5, 2.0}) {
      ContactPoints points;
      const HyperEllipsoid box{Vec3(0.3, 0.2, half_depth), exponent};
      const Pose X{Vec3(0, 0, half_depth), Quat(Eigen::AngleAxisd(1e-5, Vec3::UnitX()))};
      contacts_with_plane(box, X, Vec3::UnitZ(), 0, 0.01, points);
      ASSERT_EQ(points.size(), 4) << exponent << " " << half_depth;
      for (const SurfaceContact& c : points) {
        EXPECT_GT(c.key, 0u) << "the deepest point jumps";
        EXPECT_LT(c.gap - c.lifted, 2e-5 * 0.3) << "as deep as the side";
        EXPECT_GT(std::abs(c.p_a.x()), 0.2 * 0.3);
      }
    }
}

TEST(Faces, ShareARectangleOfKnownCorners) {
  const Pose lower{Vec3::Zero()}, upper{Vec3(0.1, 0.05, 0.2 + 1e-3)};
  ContactPoints points;
  double apart = 0;
  ASSERT_EQ(contacts_of_faces(kBox, upper, kBox, lower, 0.01, points, apart), FacesMeet::flat);
  ASSERT_EQ(points.size(), 4);
  // a side's corner points stand where its normal leans by 1e-3 in the image of a cube: (1e-3)^(1/19) of the half width
  const double half = 0.2 * std::pow(1e-3, 1.0 / 19);
  for (const SurfaceContact& c : points) {
    EXPECT_NEAR(std::min(std::abs(c.p_a.x() - half), std::abs(c.p_a.x() - (0.1 - half))), 0, 1e-4);
    EXPECT_NEAR(std::min(std::abs(c.p_a.y() - half), std::abs(c.p_a.y() - (0.05 - half))), 0, 1e-4);
    EXPECT_NEAR(c.gap, 1e-3, 2e-5);
    EXPECT_NEAR(gauge(kBox, upper.inverse() * c.p_a), 1, 1e-12);
    EXPECT_NEAR(gauge(kBox, lower.inverse() * c.p_b), 1, 1e-12);
  }
}

/// At any small lean the deepest of the patch is as deep as the search for the deepest point of both finds.
TEST(Faces, AreAsDeepAsTheDeepestPointWhenTheyLean) {
  for (const double exponent : {8.0, 20.0, 30.0})
    for (const double lean : {1e-4, 1e-3, 1e-2, 5e-2}) {
      const HyperEllipsoid box{kBox.semi_axes, exponent};
      const Pose lower{Vec3::Zero()}, upper{Vec3(0.04, 0.02, 0.199), Quat(Eigen::AngleAxisd(lean, Vec3(1, 2, 0.5).normalized()))};
      ContactPoints points;
      double apart = 0;
      ASSERT_EQ(contacts_of_faces(box, upper, box, lower, 0.01, points, apart), FacesMeet::flat);
      double deepest = 1;
      for (const SurfaceContact& c : points) deepest = std::min(deepest, c.gap);
      Vec3 guess = Vec3::Zero();
      const auto exact = contact_of_pair(box, upper, box, lower, 0.01, guess);
      ASSERT_TRUE(exact.has_value());
      EXPECT_NEAR(deepest, exact->gap, 1e-4 + 0.02 * lean) << exponent << " " << lean;
    }
}

}  // namespace
}  // namespace engine::test
