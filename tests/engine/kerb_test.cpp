// Wheels on what stands fast: over the edges of kerbs, lips and ramps, and on bodies in place of the ground.
#include <gtest/gtest.h>

#include "engine/geometry/tyre_mesh.h"
#include "engine/measure/impacts.h"
#include "tests/engine/hand_made_runs.h"
#include "tests/engine/reference_car.h"

namespace engine::test {
namespace {

constexpr double kRadius = 0.31;

/// A block with its top at z = 0.
std::shared_ptr<const TriangleMesh> block(double from, double to) {
  return box({from, -9, -3}, {to, 9, 0});
}

/// Of a wheel whose hub is at (0, 0, height).
std::optional<TyreTouch> stand(const TriangleMesh& mesh, double height, const Pose& X_WM = {}) {
  std::vector<int> scratch;
  const Tyre tyre{Vec3(0, 0, height), Vec3::UnitY(), kRadius, 0.1};
  return move_clear(tyre, mesh, X_WM, Vec3::UnitZ(), kWheelFacing, {-1, 1}, scratch);
}

TEST(TyreOnMesh, StandsOnAnEdgeAsADiscDoes) {
  const auto step = block(0, 5);
  for (double s = -0.29; s < 0; s += 0.01) {
    const Pose at{Vec3(-s, 0, 0), Quat::Identity()};
    const auto touch = stand(*step, kRadius, at);
    ASSERT_TRUE(touch) << s;
    const double z = std::sqrt(kRadius * kRadius - s * s);  // of the hub over the edge
    EXPECT_NEAR(touch->way, z - kRadius, 1e-12) << s;
    EXPECT_LT((touch->point - Vec3(-s, 0, 0)).norm(), 1e-12) << s;
    EXPECT_LT((touch->normal - Vec3(s, 0, z) / kRadius).norm(), 1e-12) << s;
  }
  EXPECT_NEAR(stand(*step, 0.2, {Vec3(-2, 0, 0), Quat::Identity()})->way, kRadius - 0.2, 1e-12);
  // steeper than a wheel mounts, and out of reach
  EXPECT_FALSE(stand(*step, kRadius, {Vec3(0.305, 0, 0), Quat::Identity()}));
  EXPECT_FALSE(stand(*step, kRadius, {Vec3(0.32, 0, 0), Quat::Identity()}));
}

TEST(TyreOnMesh, IsTangentToASlopeWhereverItsTrianglesEnd) {
  for (const double slope : {-0.5, -0.1, 0.2, 0.8}) {
    const Quat turn(Eigen::AngleAxisd(-slope, Vec3::UnitY()));
    const auto touch = stand(*block(-3, 4), 0.5, {Vec3::Zero(), turn});
    ASSERT_TRUE(touch);
    EXPECT_NEAR(touch->way, kRadius / std::cos(slope) - 0.5, 1e-12);
    EXPECT_LT((touch->normal - turn * Vec3::UnitZ()).norm(), 1e-12);
  }
}

enum class Made { plane, terrain, mesh, hyper_ellipsoid };

/// A car before a step of a given height [m], which it meets 5 m ahead; below it the ground, or nothing where it is the whole road.
Model before_step(Made of, double height, double speed, double step) {
  Model model = on_ground(4, step);
  add_reference_car(model, -5, speed);
  for (Wheel& wheel : model.vehicles[0].wheels) wheel.friction = 0.7;
  Body deck;
  deck.name = "deck";
  deck.fixed = true;
  deck.surface.friction_body = 1;
  const Vec3 lower(height > 0 ? 0 : -20, -50, height - 3), upper(200, 50, height);
  switch (of) {
    case Made::plane:
      break;
    case Made::terrain:
      model.ground.terrain = box(lower, upper);
      break;
    case Made::mesh:
      deck.shape = MeshShape{box(lower, upper), Pose{}};
      break;
    case Made::hyper_ellipsoid:
      deck.shape = HyperEllipsoid{(upper - lower) / 2, 60};
      deck.X_WB.p = (lower + upper) / 2;
      break;
  }
  if (of == Made::mesh || of == Made::hyper_ellipsoid) model.bodies.push_back(deck);
  model.ground.plane = height > 0 || of == Made::plane;
  return model;
}

TEST(Kerb, CostsWhatTheStrutsGive) {
  for (const double height : {0.01, 0.02, 0.05, 0.12}) {
    const double speed = 10, R = kRadius;
    const auto lost = [&](Made of, double step) {
      const Model model = before_step(of, height, speed, step);
      const Recording run = simulate(model);
      EXPECT_NEAR(run.at(3).bodies[0].X_WB.p.z() - run.snapshots.front().bodies[0].X_WB.p.z(), height, 0.01);
      EXPECT_TRUE(impacts_of(model, run).empty());
      return speed - run.at(3).bodies[0].V_WB.v.x();
    };
    const double terrain = lost(Made::terrain, 1e-3);
    // what it has gained in height, and what dampers take that follow the disc over the edge: c int (dz/dx)^2 dx from where the two
    // meet to where the hub is above it, for a body that does not move meanwhile
    const double reach = std::sqrt(2 * R * height - height * height);
    const double squares = 0.5 * R * std::log((R + reach) / (R - reach)) - reach;
    const Model model = before_step(Made::plane, 0, speed, 1e-3);
    const double dampers = 4 * model.vehicles[0].wheels[0].damper * squares / model.bodies[0].mass;
    const double formula = dampers + 9.81 * height / speed;
    EXPECT_NEAR(terrain, formula, 0.3 * formula) << height;
    EXPECT_NEAR(lost(Made::mesh, 1e-3), terrain, 1e-3 * terrain) << height;
    EXPECT_NEAR(lost(Made::terrain, 2.5e-4), terrain, 0.1 * terrain + 0.01) << height;
  }
}

TEST(Kerb, HigherThanAWheelMountsIsAWall) {
  for (const double speed : {3.0, 15.0})
    for (const Made of : {Made::terrain, Made::mesh}) {
      // with and without a floor of the same mesh before it
      for (const bool floor : {false, true}) {
        Model model = before_step(of, 0.29, speed, 1e-3);
        if (floor) {
          model.ground.plane = false;
          const std::vector<Vec3> corners{{-50, -9, 0},  {0, -9, 0},     {0, 9, 0},     {-50, 9, 0},
                                          {0, -9, 0.29}, {50, -9, 0.29}, {50, 9, 0.29}, {0, 9, 0.29}};
          const auto street = std::make_shared<TriangleMesh>(
              corners, std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {1, 4, 7}, {1, 7, 2}, {4, 5, 6}, {4, 6, 7}});
          if (of == Made::terrain)
            model.ground.terrain = street;
          else
            model.bodies[1].shape = MeshShape{street, Pose{}};
        }
        const Recording run = simulate(model);
        EXPECT_LT(run.snapshots.back().bodies[0].X_WB.p.x(), 0) << speed << ' ' << floor;
        EXPECT_GT(run.snapshots.back().bodies[0].X_WB.p.z(), 0.4) << speed << ' ' << floor;
      }
    }
}

TEST(Deck, OfWhateverItIsMadeIsRoad) {
  const auto end = [](Made of) {
    Model model = before_step(of, 0, 15, 1e-3);
    model.vehicles[0].steer = 0.03;
    DriverPhase braking;
    braking.first_force = 1;
    braking.force = 6000;
    model.vehicles[0].sequence.push_back(braking);
    const Recording run = simulate(model);
    EXPECT_TRUE(impacts_of(model, run).empty());
    return run.snapshots.back().bodies[0].X_WB;
  };
  const Pose on_plane = end(Made::plane);
  EXPECT_GT(std::abs(on_plane.p.y()), 1);  // it has steered
  for (const Made of : {Made::terrain, Made::mesh, Made::hyper_ellipsoid}) {
    const Pose other = end(of);
    EXPECT_LT((other.p - on_plane.p).norm(), 0.01) << static_cast<int>(of);  // of 24 m to its halt
    EXPECT_LT(other.q.angularDistance(on_plane.q), 1e-3) << static_cast<int>(of);
  }
}

void add_ramp(Model& model, const std::shared_ptr<TriangleMesh>& mesh) {
  Body ramp;
  ramp.name = "ramp";
  ramp.fixed = true;
  ramp.shape = MeshShape{mesh, {}};
  model.bodies.push_back(ramp);
}

/// A wedge that stands on the road: where the springs give way at its thin end, its underside is no wall.
TEST(Ramp, OfAThinEndIsDrivenUpAtAnySpeed) {
  constexpr double kLength = 8, kRise = 1.41;
  const auto wedge = std::make_shared<TriangleMesh>(
      std::vector<Vec3>{{0, -2, 0}, {kLength, -2, kRise}, {kLength, -2, 0}, {0, 2, 0}, {kLength, 2, kRise}, {kLength, 2, 0}},
      std::vector<Triangle>{{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {2, 5, 4}, {2, 4, 1}, {0, 3, 5}, {0, 5, 2}});
  for (const double speed : {15.0, 20.0, 30.0, 40.0}) {
    Model model = on_ground(0.9 * (5 + kLength) / speed);
    add_reference_car(model, -5, speed);
    add_ramp(model, wedge);
    const Recording run = simulate(model);
    // height takes its share; at the kink each axle loses at most what goes across the ramp, sin(10 deg)^2 / 2 of the speed, 1.5 %
    const double kept = std::sqrt(speed * speed - 2 * kGravity * kRise);
    EXPECT_GT(run.snapshots.back().bodies[0].V_WB.v.norm(), 0.97 * kept) << speed;
    EXPECT_LT(run.snapshots.back().bodies[0].V_WB.v.norm(), speed) << speed;
  }
}

/// A ramp that is a sheet: beyond the end of a surface there is nothing, neither ahead of the rims nor behind them.
TEST(Ramp, ThatIsAnOpenSheetIsDrivenOff) {
  constexpr double kLength = 8, kRise = 0.8, kAxles = 2.7;
  const auto sheet =
      std::make_shared<TriangleMesh>(std::vector<Vec3>{{0, -10, 0}, {0, 10, 0}, {kLength, -10, kRise}, {kLength, 10, kRise}},
                                     std::vector<Triangle>{{0, 2, 3}, {0, 3, 1}});
  for (const double speed : {11.0, 20.0}) {
    // until both axles are past the lip
    Model model = on_ground((5 + kLength + kAxles) / speed);
    add_reference_car(model, -5, speed);
    add_ramp(model, sheet);
    const Recording run = simulate(model);
    // the kink at the foot takes sin(5.7 deg)^2 / 2 of the speed from each axle, half of a percent; the springs keep as much
    // swinging
    EXPECT_GT(run.snapshots.back().bodies[0].V_WB.v.norm(), 0.985 * std::sqrt(speed * speed - 2 * kGravity * kRise)) << speed;
  }
}

}  // namespace
}  // namespace engine::test
