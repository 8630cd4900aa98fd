#include <algorithm>
#include <array>
#include <cmath>

#include "engine/math/functions.h"
#include "engine/measure/metrics.h"

namespace engine {
namespace {

constexpr double kHalfWidth = 0.15;  // [m] of the strip whose silhouette carries the tape

struct Point {
  double x, z;  // [m] forwards and up, body axes
};

/// Corners of the mesh cut to the strip |y - y0| <= kHalfWidth, seen from the side: their convex outline is the silhouette's.
std::vector<Point> strip(const MeshShape& shape, double y0) {
  std::vector<Point> out;
  const auto& vertices = shape.mesh->vertices();
  for (const Triangle& t : shape.mesh->triangles()) {
    std::array<Vec3, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) corner[i] = shape.X_BM * vertices[static_cast<std::size_t>(t[i])];
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& a = corner[i];
      const Vec3& b = corner[(i + 1) % 3];
      if (std::abs(a.y() - y0) <= kHalfWidth) out.push_back({a.x(), a.z()});
      for (const double y : {y0 - kHalfWidth, y0 + kHalfWidth}) {
        if ((a.y() < y) == (b.y() < y)) continue;
        const Vec3 cut = a + (y - a.y()) / (b.y() - a.y()) * (b - a);
        out.push_back({cut.x(), cut.z()});
      }
    }
  }
  return out;
}

/// Height of the ground in body axes: below the wheels at static load; without wheels where the body stood at the start.
double ground_level(const Model& model, const Body& body) {
  const Vehicle& vehicle = model.vehicles[body.vehicle];
  if (vehicle.wheels.empty()) return model.ground.height - body.X_WB.p.z();
  double lowest = 1e300;
  for (const Wheel& w : vehicle.wheels) lowest = std::min(lowest, w.hub_B.z() - w.radius);
  return lowest;
}

/// Positive if the way a, b, c turns left seen from the vehicle's right, where x points right and z up.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.z - b.z) - (b.z - a.z) * (c.x - b.x);
}

constexpr double kSkin = 0.05;  // [m] a contact lies so far inside or outside the mesh at most

/// How far behind the outermost surface the point lies, seen along `from` (unit, body axes) in its own longitudinal plane; below
/// zero: in front of it.
double behind(const MeshShape& shape, const Vec3& point_B, const Vec3& from) {
  constexpr double kFar = 50;  // [m]
  const Pose X_MB = shape.X_BM.inverse();
  double way = 0;
  int triangle = 0;
  if (!shape.mesh->raycast(X_MB * (point_B + kFar * from), X_MB.q * -from, 2 * kFar, way, triangle)) return -kFar;
  return kFar - way;
}

}  // namespace

std::optional<double> wrap_around_distance(const Model& model, int b, const Vec3& point_B) {
  const Body& body = model.bodies[b];
  const auto* shape = std::get_if<MeshShape>(&body.shape);
  if (body.vehicle < 0 || !shape) return std::nullopt;
  std::vector<Point> points = strip(*shape, point_B.y());
  const double ground = ground_level(model, body);
  // a tape from the front reaches what is open to the front without going over anything higher; what is open only upwards it
  // reaches over all that lies before it; what is neither (the underside, a flank) not at all
  const bool open_ahead = behind(*shape, point_B, Vec3::UnitX()) < kSkin;
  if (!open_ahead && behind(*shape, point_B, Vec3::UnitZ()) > kSkin) return std::nullopt;
  std::erase_if(points, [&](const Point& p) { return p.z <= ground || (open_ahead && p.z > point_B.z()); });
  if (points.empty()) return std::nullopt;
  double front = point_B.x();
  for (const Point& p : points) front = std::max(front, p.x);
  // what lies behind the impact is not under the tape
  std::erase_if(points, [&](const Point& p) { return p.x <= point_B.x(); });
  std::sort(points.begin(), points.end(), [](const Point& p, const Point& q) { return p.x != q.x ? p.x > q.x : p.z < q.z; });
  points.push_back({point_B.x(), point_B.z()});
  // a monotone chain from the ground upwards and backwards: only left turns hold a taut tape
  std::vector<Point> tape{{front, ground}};
  for (const Point& p : points) {
    while (tape.size() > 1 && turn(tape[tape.size() - 2], tape.back(), p) <= 0) tape.pop_back();
    tape.push_back(p);
  }
  double length = 0;
  for (std::size_t i = 1; i < tape.size(); ++i) length += math::hypot(tape[i].x - tape[i - 1].x, tape[i].z - tape[i - 1].z);
  return length;
}

}  // namespace engine
