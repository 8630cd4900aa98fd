// Outlines of the site diagram, against shapes whose outline is known.
#include "render/figures/outline.h"

#include <gtest/gtest.h>

#include <cmath>

namespace render {
namespace {

double area(const std::vector<Point2>& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Point2 &a = p[i], &b = p[(i + 1) % p.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum / 2;
}

TEST(Outline, OfPointsIsTheirConvexHullCounterClockwise) {
  const auto hull = convex_hull({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 0.5}, {0, 1}, {0, 0}});
  EXPECT_EQ(hull.size(), 4u) << "neither the point inside, nor the one on a side, nor the double";
  EXPECT_DOUBLE_EQ(area(hull), 2);
}

TEST(Outline, OfATurnedEllipsoidHasItsShadowsArea) {
  // long axis upright after the turn: what is left is the circle of the short ones
  const engine::HyperEllipsoid cigar{Vec3(0.1, 0.1, 0.5), 2};
  EXPECT_NEAR(area(seen_from_above(cigar, Pose{})), M_PI * 0.01, 0.005 * M_PI * 0.01) << "96 corners: 0.1 % less";
  Pose lying;
  lying.q = engine::Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()));
  EXPECT_NEAR(area(seen_from_above(cigar, lying)), M_PI * 0.05, 0.02 * M_PI * 0.05) << "fewer corners at the tips";
}

TEST(Outline, OfAMeshFollowsItsHollowsAndItsPose) {
  // an L of two rectangles: 2 x 1 and, for x in 0..1, another 1 x 1 on top of it; its hull would have 3.5
  Mesh mesh;
  auto rectangle = [&mesh](float x0, float y0, float x1, float y1) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size() / 3);
    mesh.positions.insert(mesh.positions.end(), {x0, y0, 0, x1, y0, 0, x1, y1, 0, x0, y1, 0});
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
  };
  rectangle(0, 0, 2, 1);
  rectangle(0, 1, 1, 2);
  Pose X;
  X.p = Vec3(5, 6, 7);
  X.q = engine::Quat(Eigen::AngleAxisd(0.7, Vec3::UnitZ()));
  // the step is met to a slice of 6 cm
  EXPECT_NEAR(area(seen_from_above(mesh, X)), 3, 0.06);
}

TEST(Outline, OfATwoWheelerThatLiesIsWhatCoversTheRoad) {
  // a plate 2 m long and 1 m high, thin across: upright a line, on its side a rectangle, whichever way it heads
  Mesh mesh;
  mesh.positions = {0, 0, 0, 2, 0, 0, 2, 0, 1, 0, 0, 1};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  EXPECT_NEAR(std::abs(area(seen_from_above(mesh, Pose{}))), 0, 1e-6);
  for (const double heading : {0.0, 1.0, 2.5}) {
    Pose lying;
    lying.p = Vec3(7, -3, 0.2);
    lying.q = engine::Quat(Eigen::AngleAxisd(heading, Vec3::UnitZ())) * engine::Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()));
    // slices of 6 cm at both ends hold half of their length
    EXPECT_NEAR(std::abs(area(seen_from_above(mesh, lying))), 2, 0.07) << heading;
  }
}

}  // namespace
}  // namespace render
