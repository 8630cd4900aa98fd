// Meshes, and hyper-ellipsoids and points that meet them.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "engine/geometry/hyper_ellipsoid_mesh.h"
#include "engine/geometry/hyper_ellipsoid_plane.h"
#include "engine/geometry/point_mesh.h"
#include "tests/engine/hand_made_runs.h"
#include "tests/engine/random_poses.h"

namespace engine {
namespace {

using test::random_attitude;
using test::random_direction;

TriangleMesh sheet(int cells, double size) {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j) vertices.push_back({size * (double(i) / cells - 0.5), size * (double(j) / cells - 0.5), 0});
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j) {
      const int a = i * (cells + 1) + j, b = a + cells + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  return {vertices, triangles};
}

class OnSheet : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(FromEllipsoidToBox, OnSheet, testing::ValuesIn(test::kFromEllipsoidToBox));

TEST_P(OnSheet, TrianglesActLikeAPlane) {
  const TriangleMesh mesh = sheet(23, 4);
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> place(-1, 1);
  const HyperEllipsoid shape{{0.3, 0.2, 0.1}, GetParam()};
  MeshContactScratch scratch;
  ContactPoints plane, found;
  for (int trial = 0; trial < 300; ++trial) {
    Pose X{{place(random), place(random), 0}, random_attitude(random)};
    X.p.z() = support_value(shape, X.q.conjugate() * Vec3::UnitZ()) - 0.003;
    contacts_with_plane(shape, X, Vec3::UnitZ(), 0, 0.001, plane);
    contacts_with_mesh(shape, X, mesh, {}, 0.001, -1, scratch, found);
    ASSERT_FALSE(found.empty());
    double deepest = 1, on_plane = 1;
    for (const SurfaceContact& c : found) {
      EXPECT_LT((c.normal - Vec3::UnitZ()).norm(), 1e-12);
      deepest = std::min(deepest, c.gap);
    }
    // of flat sides a plane leaves out the deepest point where its corners are as deep to some micrometres
    for (const SurfaceContact& c : plane) on_plane = std::min(on_plane, c.gap);
    EXPECT_NEAR(on_plane, -0.003, shape.exponent < 4 ? 1e-12 : 5e-6);
    EXPECT_NEAR(deepest, on_plane, 1e-9);
  }
}

TEST(SphereAndBox, TouchAtTheNearestPointOfFaceEdgeOrCorner) {
  const Vec3 half(0.5, 0.4, 0.3);
  const TriangleMesh mesh = *box(-half, half);
  const HyperEllipsoid sphere{{0.1, 0.1, 0.1}, 2};
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> place(-1, 1);
  MeshContactScratch scratch;
  ContactPoints found;
  int tried = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Vec3 c = 0.62 * Vec3(place(random), place(random), place(random));
    const Vec3 nearest = c.cwiseMax(-half).cwiseMin(half);
    const double distance = (c - nearest).norm();
    if (distance < 0.02 || distance > 0.12) continue;
    ++tried;
    contacts_with_mesh(sphere, {c, random_attitude(random)}, mesh, {}, 0.03, -1, scratch, found);
    ASSERT_FALSE(found.empty()) << c.transpose();
    EXPECT_NEAR(found[0].gap, distance - 0.1, 1e-9) << c.transpose();
    EXPECT_LT((found[0].normal - (c - nearest) / distance).norm(), 1e-7) << c.transpose();
  }
  EXPECT_GT(tried, 1000);
}

/// An ellipsoid as a convex mesh, which has faces, ridges and corners of every kind.
TriangleMesh faceted(const Vec3& half, int rings, int sides) {
  std::vector<Vec3> vertices = {{0, 0, half.z()}, {0, 0, -half.z()}};
  std::vector<Triangle> triangles;
  auto at = [&](int ring, int side) { return 2 + (ring - 1) * sides + side % sides; };
  for (int ring = 1; ring < rings; ++ring)
    for (int side = 0; side < sides; ++side) {
      const double down = std::numbers::pi * ring / rings, round = 2 * std::numbers::pi * side / sides;
      vertices.push_back(
          half.cwiseProduct(Vec3(std::sin(down) * std::cos(round), std::sin(down) * std::sin(round), std::cos(down))));
    }
  for (int side = 0; side < sides; ++side) {
    triangles.push_back({0, at(1, side), at(1, side + 1)});
    triangles.push_back({1, at(rings - 1, side + 1), at(rings - 1, side)});
    for (int ring = 1; ring < rings - 1; ++ring) {
      triangles.push_back({at(ring, side), at(ring + 1, side), at(ring + 1, side + 1)});
      triangles.push_back({at(ring, side), at(ring + 1, side + 1), at(ring, side + 1)});
    }
  }
  return {vertices, triangles};
}

TEST(MeshContact, FallsThroughBetweenNoFacesEdgesAndCornersAtAnyGap) {
  const TriangleMesh mesh = faceted({0.5, 0.4, 0.3}, 14, 23);
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> unit(0, 1);
  MeshContactScratch scratch;
  ContactPoints found;
  for (int trial = 0; trial < 400; ++trial) {
    const HyperEllipsoid shape{{0.05 + 0.1 * unit(random), 0.05 + 0.1 * unit(random), 0.1 + 0.2 * unit(random)},
                               2 + 1.5 * unit(random)};
    Pose X{Vec3::Zero(), random_attitude(random)};
    // the distance of two convex bodies, negative where they overlap: the largest that a direction keeps them apart
    auto apart = [&](const Vec3& m) {
      double far = -1;
      for (const Vec3& v : mesh.vertices()) far = std::max(far, m.dot(v));
      return m.dot(X.p) - support_value(shape, X.q.conjugate() * -m) - far;
    };
    const Vec3 from = random_direction(random);
    X.p = Vec3(0.5, 0.4, 0.3).cwiseProduct(from) + (0.02 + 0.3 * unit(random)) * from;
    Vec3 best = from;
    double distance = apart(best);
    for (double reach = 0.5; reach > 1e-8; reach *= 0.93)
      for (int k = 0; k < 12; ++k) {
        const Vec3 m = (best + reach * random_direction(random)).normalized();
        if (const double d = apart(m); d > distance) best = m, distance = d;
      }
    if (distance < -0.02 || distance > 0.035) continue;
    contacts_with_mesh(shape, X, mesh, {}, 0.04, -1, scratch, found);
    ASSERT_FALSE(found.empty()) << trial << ": " << distance;
    double least = 1;
    for (const SurfaceContact& c : found) least = std::min(least, c.gap);
    EXPECT_GT(least, distance - 1e-9) << trial;  // a search finds at most the largest
    EXPECT_LT(least, distance + 1e-5) << trial;
  }
}

TEST(MeshContact, PassesASlightRidgeWithoutACrack) {
  // A limb's point of support goes over a millimetre for a fifth of a milliradian: over a ridge as slight as those between the
  // triangles of a bonnet there is a strip in which it stands over neither face.
  const HyperEllipsoid limb{{0.18, 0.045, 0.045}, 2.5};
  MeshContactScratch scratch;
  ContactPoints found;
  for (const double slope : {1e-15, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6, 1e-4, 4.9e-4, 1e-3}) {
    const TriangleMesh mesh({{0, -1, 0}, {0, 1, 0}, {1, 0, -slope}, {-1, 0, -slope}}, {{0, 2, 1}, {0, 1, 3}});
    for (const double depth : {-5e-4, 1e-3, 0.011}) {
      double before = 0;
      for (int k = -300; k <= 300; ++k) {
        const Pose X{{1e-5 * k, 0.013, 0.045 - depth}, Quat::Identity()};
        contacts_with_mesh(limb, X, mesh, {}, 2e-3, -1, scratch, found);
        ASSERT_FALSE(found.empty()) << "slope " << slope << ", depth " << depth << ", " << 1e-2 * k << " mm beside the ridge";
        double gap = 1;
        for (const SurfaceContact& c : found) gap = std::min(gap, c.gap);
        EXPECT_NEAR(gap, -depth, 3e-3 * slope + 1e-12);  // the faces fall away by no more
        if (k > -300) {
          EXPECT_LE(std::abs(gap - before), 1.01e-5 * slope + 1e-12) << slope << " " << depth << " " << k;
        }
        before = gap;
      }
    }
  }
}

/// A body of n = 3 whose support point goes like the root of the angle, where its flat side looks at an edge.
TEST(MeshContact, FindsAnEdgeThatAFlatSideLooksAt) {
  const TriangleMesh wedge({{0, -1, 0}, {0, 1, 0}, {-1, 0, -1}, {1, 0, -1}}, {{0, 1, 2}, {0, 3, 1}});
  const HyperEllipsoid hips{{0.064, 0.101, 0.043}, 3};
  MeshContactScratch scratch;
  ContactPoints found;
  for (int k = -50; k <= 50; ++k) {
    const double aside = 1e-4 * k, lean = 2e-3 * k;
    const Pose X{{aside, 0, 0.042}, Quat(Eigen::AngleAxisd(lean, Vec3(0.3, 1, 0.2).normalized()))};
    double deepest = -1;  // of all directions across the edge the one that keeps them farthest apart
    for (int i = -20000; i <= 20000; ++i) {
      const double angle = 0.78 * i / 20000;
      const Vec3 m(std::sin(angle), 0, std::cos(angle));
      deepest = std::max(deepest, m.dot(X.p) - support_value(hips, X.q.conjugate() * -m));
    }
    contacts_with_mesh(hips, X, wedge, {}, 5e-3, -1, scratch, found);
    ASSERT_FALSE(found.empty()) << k;
    double least = 1;
    for (const SurfaceContact& c : found) least = std::min(least, c.gap);
    EXPECT_NEAR(least, deepest, 1e-7) << k;
  }
}

TEST(MeshContact, IsNotFeltThroughTheBodyFromBehind) {
  // a floor, and above the sphere's centre a scrap that faces down, as a fold of a bonnet's edge faces the inside of a car
  std::vector<Vec3> vertices = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {-1, -1, 0.11}, {1, -1, 0.11}, {0, 1, 0.11}};
  const TriangleMesh mesh(vertices, {{0, 1, 2}, {3, 5, 4}});
  const HyperEllipsoid sphere{{0.1, 0.1, 0.1}, 2};
  const Pose X{{0, 0, 0.0995}, Quat::Identity()};
  MeshContactScratch scratch;
  ContactPoints found;
  contacts_with_mesh(sphere, X, mesh, {}, 0.01, -1, scratch, found);  // nothing known: both
  ASSERT_EQ(found.size(), 2);
  EXPECT_NEAR(scratch.apart, -0.0895, 1e-12);
  contacts_with_mesh(sphere, X, mesh, {}, 0.01, -0.001, scratch, found);  // a millimetre at most was seen
  ASSERT_EQ(found.size(), 1);
  EXPECT_NEAR(found[0].normal.z(), 1, 1e-12);
  EXPECT_NEAR(scratch.apart, -0.0005, 1e-12);
}

TEST(Mesh, LoaderAuditDropsWhatHasNoArea) {
  const TriangleMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1e-7, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {3, 1, 2}, {0, 1, 4}, {0, 0, 1}});
  EXPECT_EQ(mesh.triangles().size(), 1u);
  EXPECT_EQ(mesh.dropped_triangles(), 3);
}

TEST(Mesh, RayMeetsTheNearestTriangle) {
  const TriangleMesh mesh = *box({-1, -1, -1}, {1, 1, 1});
  double s = 0;
  int triangle = -1;
  ASSERT_TRUE(mesh.raycast({0.3, 0.2, 5}, {0, 0, -1}, 10, s, triangle));
  EXPECT_NEAR(s, 4, 1e-12);
  EXPECT_GT(mesh.face_normals()[triangle].z(), 0.99);
  EXPECT_FALSE(mesh.raycast({3, 0, 5}, {0, 0, -1}, 10, s, triangle));
}

/// On an edge, on a corner, and in the middle between two sides no triangle comes first: the normal is that of the form.
TEST(PointMesh, NormalsWhereSeveralFacesAreAsNearAreThoseOfTheForm) {
  const auto cube = box({-1, -1, -1}, {1, 1, 1});
  std::vector<int> scratch;
  const auto normal_at = [&](const Vec3& p) { return nearest_surface(*cube, p, 1.5, scratch)->normal; };
  const Vec3 of_edge = Vec3(1, 1, 0).normalized(), of_corner = Vec3(1, 1, 1).normalized();
  for (const double off : {0.0, 3e-9, -3e-9}) {
    EXPECT_LT((normal_at({1 + off, 1, 0.3}) - of_edge).norm(), 1e-6) << off;
    EXPECT_LT((normal_at({1, 1 + off, 1}) - of_corner).norm(), 1e-6) << off;
  }
  EXPECT_LT((normal_at({0.9, 0.9, 0.3}) - of_edge).norm(), 1e-9) << "inside, as near to both";
  EXPECT_LT((normal_at({0.9, 0.8, 0.3}) - Vec3::UnitX()).norm(), 1e-9);
  EXPECT_LT((normal_at({1, 0.3, 0.3}) - Vec3::UnitX()).norm(), 1e-9);
}

/// Where a mesh ends, a point beside its edge or its corner is outside, above the face and below it.
TEST(PointMesh, NothingBeyondAnOpenEdgeIsInside) {
  const TriangleMesh sheet({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  std::vector<int> scratch;
  for (const double above : {1e-3, -1e-3})
    for (const auto& [beyond, nearest] : {std::pair{Vec3(1.02, 0.4, above), Vec3(1, 0.4, 0)},
                                          {Vec3(1.01, 1.01, above), Vec3(1, 1, 0)},
                                          {Vec3(-0.01, -0.01, above), Vec3(0, 0, 0)}}) {
      const auto surface = nearest_surface(sheet, beyond, 0.15, scratch);
      EXPECT_NEAR(surface->gap, (beyond - nearest).norm(), 1e-12);
      EXPECT_LT((surface->normal - (beyond - nearest).normalized()).norm(), 1e-9);
    }
  EXPECT_LT(nearest_surface(sheet, {0.9, 0.4, -1e-3}, 0.15, scratch)->gap, 0);
}

}  // namespace
}  // namespace engine
