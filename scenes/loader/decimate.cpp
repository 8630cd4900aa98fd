// Edges are collapsed by quadric error (render/surface/simplify.h). It bounds how far corners are from planes, not how far surfaces
// are apart, so every result is held against the given mesh: the distance to one triangle is a convex function, largest over
// another triangle at one of its corners. If all corners are near enough to one and the same triangle, every point between them is.
// If only some are, that part is cut off and the rest is asked again, nearer to another triangle; or it is halved. What is not
// certain after many cuts is refused, and less is collapsed.
#include "scenes/loader/decimate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/geometry/point_mesh.h"
#include "engine/math/roots.h"
#include "render/surface/simplify.h"

namespace scenes {
namespace {

using engine::Triangle;
using engine::TriangleMesh;
using engine::Vec3;

constexpr int kCuts = 40;           // one after the other, of one triangle
constexpr double kWorthACut = 0.2;  // [-] of a side; a smaller part is not worth it
constexpr double kEager = 1.0;      // first quadric error tried, in tolerances
constexpr double kLessEager = 0.7;  // each further one
constexpr int kTries = 12;          // the last asks for a fiftieth

class Certificate {
 public:
  Certificate(const TriangleMesh& surface, double tolerance) : surface_(surface), tolerance_(tolerance) {}

  bool holds(const Vec3& a, const Vec3& b, const Vec3& c, int cuts = kCuts) {
    const auto nearest = engine::nearest_surface(surface_, (a + b + c) / 3, tolerance_, scratch_);
    if (!nearest || cuts == 0) return false;
    const int t = nearest->triangle;
    std::array<Vec3, 3> p = {a, b, c};
    // the near corners first, in the order of the triangle
    std::array<bool, 3> near = {is_near(a, t), is_near(b, t), is_near(c, t)};
    const int count = near[0] + near[1] + near[2];
    if (count == 3) return true;
    for (int turn = 0; turn < 2 && count > 0 && !(near[0] && (count == 1 || near[1])); ++turn) {
      std::rotate(p.begin(), p.begin() + 1, p.end());
      std::rotate(near.begin(), near.begin() + 1, near.end());
    }
    if (count == 2) {
      const double u = share_near(p[0], p[2], t), v = share_near(p[1], p[2], t);
      if (std::min(u, v) > kWorthACut) return holds(along(p[0], p[2], u), along(p[1], p[2], v), p[2], cuts - 1);
    } else if (count == 1) {
      const double u = share_near(p[0], p[1], t), v = share_near(p[0], p[2], t);
      const Vec3 at1 = along(p[0], p[1], u), at2 = along(p[0], p[2], v);
      if (std::min(u, v) > kWorthACut) return holds(at1, p[1], p[2], cuts - 1) && holds(at1, p[2], at2, cuts - 1);
    }
    return halves_hold(p, cuts);
  }

 private:
  static Vec3 along(const Vec3& from, const Vec3& to, double share) { return from + share * (to - from); }

  bool is_near(const Vec3& p, int triangle) const { return distance(p, triangle) <= tolerance_; }

  double distance(const Vec3& p, int triangle) const {
    const Triangle& t = surface_.triangles()[static_cast<std::size_t>(triangle)];
    const auto corner = [&](std::size_t k) { return surface_.vertices()[static_cast<std::size_t>(t[k])]; };
    return (p - engine::nearest_in_triangle(p, corner(0), corner(1), corner(2))).norm();
  }

  /// How much of the way from a near to a far point is well within the tolerance.
  double share_near(const Vec3& near, const Vec3& far, int triangle) const {
    const double limit = 0.5 * (distance(near, triangle) + tolerance_);
    return engine::math::bisect({0, 1}, 12, 0, [&](double share) { return distance(along(near, far, share), triangle) <= limit; })
        .low;
  }

  /// Divided across its longest side.
  bool halves_hold(std::array<Vec3, 3> p, int cuts) {
    double longest = 0;
    std::size_t from = 0;
    for (std::size_t k = 0; k < 3; ++k)
      if (const double side = (p[(k + 1) % 3] - p[k]).squaredNorm(); side > longest) longest = side, from = k;
    const Vec3 middle = 0.5 * (p[from] + p[(from + 1) % 3]);
    const Vec3& opposite = p[(from + 2) % 3];
    return holds(p[from], middle, opposite, cuts - 1) && holds(middle, p[(from + 1) % 3], opposite, cuts - 1);
  }

  const TriangleMesh& surface_;
  double tolerance_;
  std::vector<int> scratch_;
};

std::shared_ptr<const TriangleMesh> collapse(const TriangleMesh& mesh, double error) {
  render::Mesh shape;
  for (const Vec3& v : mesh.vertices())
    for (int k = 0; k < 3; ++k) shape.positions.push_back(static_cast<float>(v[k]));
  for (const Triangle& t : mesh.triangles())
    for (const int i : t) shape.indices.push_back(static_cast<std::uint32_t>(i));
  const std::vector<std::uint32_t> kept = render::collapsed(shape, error);
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
