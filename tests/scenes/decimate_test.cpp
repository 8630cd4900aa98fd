// A thinned mesh against the one it came from.
#include "scenes/loader/decimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/geometry/point_mesh.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_file.h"

namespace scenes {
namespace {

using engine::Triangle;
using engine::TriangleMesh;
using engine::Vec3;

/// A sheet of n x n squares over 2 m x 2 m, arched like a bonnet.
std::shared_ptr<const TriangleMesh> arched(int n, double lift = 0) {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k) {
      const double x = 2.0 * i / n - 1, y = 2.0 * k / n - 1;
      vertices.push_back({x, y, lift + 0.2 * std::cos(x) * std::cos(y)});
    }
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const int a = i * (n + 1) + k, b = a + n + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  return std::make_shared<TriangleMesh>(vertices, triangles);
}

/// Largest distance of random points of `a` from `b`: a lower bound of the distance of the surfaces.
double sampled_distance(const TriangleMesh& a, const TriangleMesh& b) {
  std::mt19937 chance(5);
  std::uniform_real_distribution<> share(0, 1);
  std::vector<int> scratch;
  double largest = 0;
  for (const Triangle& t : a.triangles())
    for (int i = 0; i < 20; ++i) {
      double u = share(chance), v = share(chance);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3& o = a.vertices()[t[0]];
      const Vec3 p = o + u * (a.vertices()[t[1]] - o) + v * (a.vertices()[t[2]] - o);
      const auto nearest = engine::nearest_surface(b, p, 0.5, scratch);
      largest = std::max(largest, nearest ? std::abs(nearest->gap) : 0.5);
    }
  return largest;
}

TEST(Decimate, StaysWithinItsBoundBothWays) {
  const auto full = arched(40);
  std::size_t last = full->triangles().size();
  for (const double tolerance : {0.001, 0.005, 0.02}) {
    const auto coarse = decimate(full, tolerance);
    EXPECT_LT(coarse->triangles().size(), last) << tolerance;
    last = coarse->triangles().size();
    EXPECT_LE(sampled_distance(*full, *coarse), tolerance);
    EXPECT_LE(sampled_distance(*coarse, *full), tolerance);
  }
  EXPECT_EQ(decimate(full, 0), full);
}

TEST(Decimate, CertifiesNoSurfaceThatIsFartherAway) {
  const auto full = arched(20), lifted = arched(20, 0.01);
  EXPECT_TRUE(lies_within(*lifted, *full, 0.0101));
  EXPECT_FALSE(lies_within(*lifted, *full, 0.0095));  // on the arch's top the surfaces are 1 cm apart
  // a hole of one square: its middle is 5 cm from the rim
  std::vector<Triangle> holed = full->triangles();
  holed.erase(holed.begin() + 420, holed.begin() + 422);
  const TriangleMesh with_hole(full->vertices(), holed);
  EXPECT_TRUE(lies_within(with_hole, *full, 0.001));
  EXPECT_FALSE(lies_within(*full, with_hole, 0.03));
}

TEST(Decimate, ThinsOutTheMeshOfAVehicle) {
  const std::string file = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/intersection_ks.toml";
  const Scene full = load(file), coarse = load(file, {"vehicle.red.mesh_tolerance=10 mm"});
  const auto mesh_of = [](const Scene& scene) { return std::get<engine::MeshShape>(scene.model.bodies[0].shape); };
  EXPECT_EQ(mesh_of(coarse).tolerance, 0.01);
  EXPECT_LT(5 * mesh_of(coarse).mesh->triangles().size(), 4 * mesh_of(full).mesh->triangles().size());
  EXPECT_LE(sampled_distance(*mesh_of(full).mesh, *mesh_of(coarse).mesh), 0.01);
}

TEST(Decimate, GivesCarsOfOneKindTheSameTriangles) {
  const auto car = [](const std::string& name, const std::string& tolerance) {
    return "[[vehicle]]\nname = \"" + name + "\"\nmodel = \"sedan\"\nmesh_tolerance = \"" + tolerance + "\"\n";
  };
  const Scene scene = testing::SceneFolder().load(car("first", "10 mm") + car("second", "10 mm") + car("fine", "5 mm"));
  const auto mesh_of = [&](int body) { return std::get<engine::MeshShape>(scene.model.bodies[body].shape).mesh; };
  EXPECT_EQ(mesh_of(0), mesh_of(1));
  EXPECT_NE(mesh_of(0), mesh_of(2));
}

}  // namespace
}  // namespace scenes
