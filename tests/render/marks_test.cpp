// What lies on the ground follows it: marks, traces and paths over the creases of a terrain.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/arrange.h"

namespace render {
namespace {

/// Level up to y = 0, then down at 30 degrees, then level again 3 m lower.
double height_at(double y) {
  return -std::clamp(y * std::tan(M_PI / 6), 0.0, 3.0);
}

std::shared_ptr<const engine::TriangleMesh> bank() {
  std::vector<Vec3> points;
  std::vector<engine::Triangle> triangles;
  const double foot = 3 / std::tan(M_PI / 6);
  for (const double y : {-20.0, 0.0, foot, 30.0})
    for (const double x : {-20.0, 20.0}) points.emplace_back(x, y, height_at(y));
  for (int i = 0; i < 3; ++i) {
    triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }
  return std::make_shared<engine::TriangleMesh>(points, triangles);
}

/// Two wheels side by side, locked or rolling, aslant over the bank with the speed of a car: a recorded instant every 0.15 m.
engine::Recording crossing(double slip) {
  engine::Recording r;
  r.body_names = {"car"};
  r.interval = 0.01;
  for (int i = 0; i <= 100; ++i) {
    engine::Snapshot s;
    s.time = 0.01 * i;
    s.bodies.own().resize(1);
    const double y = -6 + 0.15 * i;
    s.bodies.own()[0].X_WB.p = Vec3(0.3 * y, y, height_at(y) + 0.5);
    for (const double side : {-0.8, 0.8}) {
      engine::WheelRecord wheel;
      wheel.contact = Vec3(0.3 * y + side, y, height_at(y));
      wheel.load = 4000;
      wheel.slip = slip;
      s.wheels.push_back(wheel);
    }
    r.snapshots.push_back(s);
  }
  return r;
}

DrawList drawn(double slip) {
  Stage stage;
  Camera side;
  side.name = "side";
  stage.cameras.push_back(side);
  stage.vehicles = {0};
  stage.road.terrain_surface = bank();
  stage.road.terrain = std::make_shared<Mesh>();
  stage.overlays.set("wheel_traces"), stage.overlays.set("vehicle_paths");
  return arrange(stage, crossing(slip), {1.0, "side", 1}, 1.78);
}

/// Between the points a straight piece of 0.1 m cuts a crease of 30 degrees by at most 0.05 m x tan 15 = 13 mm; what lies on it is
/// lifted by 10 to 20 mm.
void expect_on_the_ground(const Float3& a, const Float3& b) {
  for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double y = (1 - s) * static_cast<double>(a[1]) + s * static_cast<double>(b[1]);
    const double over = (1 - s) * static_cast<double>(a[2]) + s * static_cast<double>(b[2]) - height_at(y);
    EXPECT_GT(over, -0.008) << "under it at y = " << y;
    EXPECT_LT(over, 0.04) << "floats over it at y = " << y;
  }
}

TEST(Marks, OfSlidingTyresLieOnTheTerrainWithBothEdges) {
  const DrawList list = drawn(5);
  ASSERT_EQ(list.strips.size(), 2u);
  for (const StripItem& strip : list.strips) {
    ASSERT_GT(strip.left.size(), 140u);
    EXPECT_LT(strip.left.front()[1], -5.8f);
    EXPECT_GT(strip.left.back()[1], 8.8f);
    for (std::size_t i = 1; i < strip.left.size(); ++i) {
      expect_on_the_ground(strip.left[i - 1], strip.left[i]);
      expect_on_the_ground(strip.right[i - 1], strip.right[i]);
    }
  }
}

TEST(Marks, OfRollingTyresAreTracesOnTheTerrainAndNoStrips) {
  const DrawList list = drawn(0);
  EXPECT_TRUE(list.strips.empty());
  std::size_t pieces = 0;
  for (const LineItem& line : list.lines) {
    if (line.occluded != render::Occluded::hidden) continue;
    ASSERT_EQ(line.normals.size(), line.points.size());
    for (std::size_t i = 1; i < line.points.size(); ++i, ++pieces) expect_on_the_ground(line.points[i - 1], line.points[i]);
  }
  EXPECT_GT(pieces, 3 * 140u) << "two wheels and the vehicle's path";
}

}  // namespace
}  // namespace render
