// Edges are collapsed by quadric error (M. Garland, P. Heckbert, SIGGRAPH 1997; meshoptimizer). That error is an average and no
// bound, so every result is held against the given mesh: the distance to one triangle is a convex function, largest over another
// triangle at one of its corners. If all corners are near enough to one and the same triangle, every point between them is;
// if not, the triangle is quartered. What is not certain at the smallest quarter is refused, and less is collapsed.
#include "scenes/loader/decimate.h"

#include <meshoptimizer.h>

#include <cmath>

#include "engine/geometry/point_mesh.h"

namespace scenes {
namespace {

using engine::Triangle;
using engine::TriangleMesh;
using engine::Vec3;

constexpr int kQuarterings = 6;     // of an edge of 1 m that leaves 16 mm
constexpr double kEager = 2.0;      // the quadric error may be larger than the distance: first try
constexpr double kLessEager = 0.7;  // each further one
constexpr int kTries = 12;          // the last asks for a fiftieth

class Certificate {
 public:
  Certificate(const TriangleMesh& surface, double tolerance) : surface_(surface), tolerance_(tolerance) {}

  bool holds(const Vec3& a, const Vec3& b, const Vec3& c, int quarterings = kQuarterings) {
    const auto nearest = engine::nearest_surface(surface_, (a + b + c) / 3, tolerance_, scratch_);
    if (!nearest) return false;
    if (near(a, nearest->triangle) && near(b, nearest->triangle) && near(c, nearest->triangle)) return true;
    if (quarterings == 0) return false;
    const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    return holds(ab, bc, ca, quarterings - 1) && holds(a, ab, ca, quarterings - 1) && holds(ab, b, bc, quarterings - 1) &&
           holds(ca, bc, c, quarterings - 1);
  }

 private:
  bool near(const Vec3& p, int triangle) const {
    const Triangle& t = surface_.triangles()[static_cast<std::size_t>(triangle)];
    const auto& v = surface_.vertices();
    return (p - engine::nearest_in_triangle(p, v[static_cast<std::size_t>(t[0])], v[static_cast<std::size_t>(t[1])],
                                            v[static_cast<std::size_t>(t[2])]))
               .squaredNorm() <= tolerance_ * tolerance_;
  }

  const TriangleMesh& surface_;
  double tolerance_;
  std::vector<int> scratch_;
};

std::shared_ptr<const TriangleMesh> collapse(const TriangleMesh& mesh, double error) {
  std::vector<float> positions;
  for (const Vec3& v : mesh.vertices())
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(v[k]));
  std::vector<unsigned int> indices;
  for (const Triangle& t : mesh.triangles())
    for (const int i : t) indices.push_back(static_cast<unsigned int>(i));
  constexpr std::size_t kStride = 3 * sizeof(float);
  const std::size_t vertices = mesh.vertices().size();
  const float scale = meshopt_simplifyScale(positions.data(), vertices, kStride);
  std::vector<unsigned int> kept(indices.size());
  kept.resize(meshopt_simplify(kept.data(), indices.data(), indices.size(), positions.data(), vertices, kStride, 0,
                               static_cast<float>(error) / scale, meshopt_SimplifyLockBorder, nullptr));
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i + 2 < kept.size(); i += 3)
    triangles.push_back({static_cast<int>(kept[i]), static_cast<int>(kept[i + 1]), static_cast<int>(kept[i + 2])});
  return std::make_shared<TriangleMesh>(mesh.vertices(), std::move(triangles));
}

}  // namespace

bool lies_within(const TriangleMesh& a, const TriangleMesh& b, double tolerance) {
  Certificate certificate(b, tolerance);
  for (const Triangle& t : a.triangles()) {
    const auto corner = [&](std::size_t k) { return a.vertices()[static_cast<std::size_t>(t[k])]; };
    if (!certificate.holds(corner(0), corner(1), corner(2))) return false;
  }
  return true;
}

std::shared_ptr<const TriangleMesh> decimate(const std::shared_ptr<const TriangleMesh>& mesh, double tolerance) {
  if (!(tolerance > 0)) return mesh;
  double error = kEager * tolerance;
  for (int i = 0; i < kTries; ++i, error *= kLessEager) {
    const auto coarse = collapse(*mesh, error);
    if (coarse->triangles().size() < mesh->triangles().size() && lies_within(*mesh, *coarse, tolerance) &&
        lies_within(*coarse, *mesh, tolerance))
      return coarse;
  }
  return mesh;
}

}  // namespace scenes
