// The form of the hyper-ellipsoid, and its depth in a plane.
#include "engine/geometry/hyper_ellipsoid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "engine/geometry/hyper_ellipsoid_plane.h"
#include "tests/engine/random_poses.h"

namespace engine {
namespace {

using test::random_attitude;
using test::random_direction;

class Exponent : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(FromEllipsoidToBox, Exponent, testing::ValuesIn(test::kFromEllipsoidToBox));

TEST_P(Exponent, VolumeAndInertiaAgreeWithQuadrature) {
  const HyperEllipsoid shape{{0.3, 0.2, 0.1}, GetParam()};
  // midpoint rule over one octant: counts cells whose centre is inside
  const int cells = 120;
  double V = 0, xx = 0;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k) {
        const Vec3 x = shape.semi_axes.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5) / cells);
        if (gauge(shape, x) > 1) continue;
        V += 1;
        xx += x.y() * x.y() + x.z() * x.z();
      }
  const double cell = 8 * shape.semi_axes.prod() / std::pow(cells, 3);
  // the surface cuts some cells^2 cells, half of each miscounted at random: relative error about 1 / cells^1.5
  EXPECT_NEAR(volume(shape) / (V * cell), 1, 2e-3);
  EXPECT_NEAR(principal_inertia(shape, 1).x() / (xx / V), 1, 2e-3);
}

TEST(HyperEllipsoid, HasTheEllipsoidsAndTheBoxsInertiaAsItsEnds) {
  EXPECT_NEAR(principal_inertia({{3, 2, 1}, 2}, 5).x(), 5.0 / 5 * (4 + 1), 1e-12);
  EXPECT_NEAR(volume({{3, 2, 1}, 2}), 4.0 / 3 * std::numbers::pi * 6, 1e-12);
  EXPECT_NEAR(principal_inertia({{3, 2, 1}, 30}, 1).x() / 5, 0.33121, 1e-5);
}

TEST_P(Exponent, SupportPointIsOnTheSurfaceFarthestAndItsNormalIsTheDirection) {
  std::mt19937_64 random(11);
  const HyperEllipsoid shape{{0.3, 0.2, 0.1}, GetParam()};
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 d = random_direction(random);
    const Vec3 s = support_point(shape, d);
    EXPECT_NEAR(gauge(shape, s), 1, 1e-12);
    EXPECT_NEAR(s.dot(d), support_value(shape, d), 1e-13);
    EXPECT_LT((outward_normal(shape, s) - d).norm(), 1e-7) << d.transpose();
    for (int k = 0; k < 20; ++k) EXPECT_LE(radial_point(shape, random_direction(random)).dot(d), support_value(shape, d) + 1e-12);
  }
}

TEST_P(Exponent, SupportsOfTwoBodiesAreTheSameTogetherAsOneByOne) {
  std::mt19937_64 random(12);
  const HyperEllipsoid a{{0.3, 0.2, 0.1}, GetParam()}, b{{0.1, 0.15, 0.4}, 2.5};
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 d = random_direction(random), e = random_direction(random);
    const auto [of_a, of_b] = scaled(unscaled_support(a, d), unscaled_support(b, e));
    EXPECT_EQ(of_a.value, support(a, d).value);
    EXPECT_EQ(of_a.point, support(a, d).point);
    EXPECT_EQ(of_b.value, support(b, e).value);
    EXPECT_EQ(of_b.point, support(b, e).point);
  }
}

TEST_P(Exponent, SupportBoundHoldsAndIsTight) {
  std::mt19937_64 random(5);
  double most = 1;
  const HyperEllipsoid shape{{0.3, 0.2, 0.1}, GetParam()};
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 d = trial < 3 ? Vec3(Vec3::Unit(trial)) : random_direction(random);
    const double ratio = support_bound(shape, d) / support_value(shape, d);
    EXPECT_GE(ratio, 1) << d.transpose();
    most = std::max(most, ratio);
  }
  EXPECT_LT(most, GetParam() == 2 ? 1 + 1e-13 : 1.05);
}

TEST_P(Exponent, GradientsAndHessiansAreThoseOfTheirFunctions) {
  std::mt19937_64 random(5);
  const HyperEllipsoid shape{{0.3, 0.2, 0.1}, GetParam()};
  const double eps = 1e-6;
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 x = 0.2 * random_direction(random);
    const Vec3 d = random_direction(random);
    if (d.cwiseAbs().minCoeff() < 0.05 || x.cwiseAbs().minCoeff() < 0.01)
      continue;  // there differences see the flats' singular curvature
    for (int i = 0; i < 3; ++i) {
      const Vec3 e = eps * Vec3::Unit(i);
      EXPECT_NEAR((gauge(shape, x + e) - gauge(shape, x - e)) / (2 * eps), gauge_gradient(shape, x)[i],
                  1e-5 * (1 + std::abs(gauge_gradient(shape, x)[i])));
      const Vec3 dg = (gauge_gradient(shape, x + e) - gauge_gradient(shape, x - e)) / (2 * eps);
      EXPECT_LT((dg - gauge_hessian(shape, x).col(i)).norm(), 1e-3 * (1 + dg.norm()));
      const Vec3 ds = (support_point(shape, d + e) - support_point(shape, d - e)) / (2 * eps);
      EXPECT_LT((ds - support_hessian(shape, d, support(shape, d)).col(i)).norm(), 1e-4 * (1 + ds.norm()));
    }
  }
}

TEST_P(Exponent, DepthInAPlaneIsExact) {
  std::mt19937_64 random(3);
  const HyperEllipsoid shape{{0.3, 0.2, 0.1}, GetParam()};
  ContactPoints out;
  for (int trial = 0; trial < 300; ++trial) {
    const Pose X{{0.1, -0.2, 0.05}, random_attitude(random)};
    contacts_with_plane(shape, X, Vec3::UnitZ(), 0, 1, out);
    ASSERT_FALSE(out.empty());
    double deepest = 1;
    for (const SurfaceContact& c : out) deepest = std::min(deepest, c.gap);
    // the manifold leaves out a deepest point no more than 5 micrometres below its corners
    EXPECT_NEAR(deepest, X.p.z() - support_value(shape, X.q.conjugate() * Vec3::UnitZ()), GetParam() < 4 ? 1e-13 : 5.001e-6);
  }
}

}  // namespace
}  // namespace engine
