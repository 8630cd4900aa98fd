#include "engine/geometry/point_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "engine/math/functions.h"

namespace engine {
// C. Ericson, Real-Time Collision Detection, 2005, section 5.1.5
Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double sum = va + vb + vc;
  return a + vb / sum * ab + vc / sum * ac;
}

namespace {

constexpr double kOn = 1e-6;    // [m] a point so near lies on the surface
constexpr double kSame = 1e-9;  // [m] as near

/// Angle [rad] that a triangle has at a point of it: of a corner, half a turn of an edge, a whole one within.
double angle_at(const Vec3& p, const Triangle& v, const std::vector<Vec3>& vertices) {
  double angle = 2 * std::numbers::pi;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = vertices[v[i]], &b = vertices[v[(i + 1) % 3]], &c = vertices[v[(i + 2) % 3]];
    const Vec3 ab = b - a, ac = c - a;
    if ((p - a).norm() < kOn) return math::atan2(ab.cross(ac).norm(), ab.dot(ac));
    if ((p - a).cross(ab).norm() < kOn * ab.norm()) angle = std::numbers::pi;
  }
  return angle;
}

/// Does a point of a triangle lie where the mesh ends?
bool on_rim(const TriangleMesh& mesh, int t, const Vec3& p) {
  const auto is_open = [&mesh](int triangle, std::size_t edge) {
    return mesh.edge_kind(triangle, static_cast<int>(edge)) == EdgeKind::open;
  };
  const Triangle& v = mesh.triangles()[t];
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = mesh.vertices()[v[i]], &b = mesh.vertices()[v[(i + 1) % 3]];
    if (is_open(t, i) && (p - a).cross(b - a).norm() < kOn * (b - a).norm()) return true;
    if ((p - a).norm() > kOn) continue;
    for (const int other : mesh.triangles_at(v[i]))
      for (std::size_t k = 0; k < 3; ++k) {
        const Triangle& w = mesh.triangles()[other];
        if ((w[k] == v[i] || w[(k + 1) % 3] == v[i]) && is_open(other, k)) return true;
      }
  }
  return false;
}

/// A triangle and a point beside it.
struct Beside {
  Vec3 nearest, normal;
  double distance = 0, along = 0;  // [m] of the point, and by the face's normal
};

/// Whether a triangle is farther than `reach` by its plane alone: many of those about a point are, and need no more looking at.
bool is_beyond(const TriangleMesh& mesh, int t, const Vec3& p, double reach) {
  return std::abs(mesh.face_normals()[t].dot(p - mesh.vertices()[mesh.triangles()[t][0]])) > reach + 2 * kSame;
}

Beside beside(const TriangleMesh& mesh, int t, const Vec3& p) {
  const Triangle& v = mesh.triangles()[t];
  Beside out;
  out.nearest = nearest_in_triangle(p, mesh.vertices()[v[0]], mesh.vertices()[v[1]], mesh.vertices()[v[2]]);
  out.normal = mesh.face_normals()[t];
  out.distance = (p - out.nearest).norm();
  out.along = out.normal.dot(p - out.nearest);
  if (out.distance <= kOn || std::abs(out.along) >= 0.999 * out.distance) return out;
  // beside an edge or a corner the normal points from it to the point; where the mesh ends nothing beside it is within
  if (out.along < 0 && on_rim(mesh, t, out.nearest)) out.along = -out.along;
  out.normal = (out.along < 0 ? -1.0 : 1.0) / out.distance * (p - out.nearest);
  return out;
}

/// Where several faces are as near, on an edge, a corner or in the middle between two sides: the mean of their normals, each
/// weighted by the angle its face has there (Thuermer and Wuethrich 1998). It hangs neither on the order of the triangles nor on
/// how they cut a flat face.
void take_the_mean(const TriangleMesh& mesh, const std::vector<int>& near, const Vec3& p, NearestSurface& best, double facing) {
  Vec3 sum = Vec3::Zero();
  bool one = true;
  const double least = std::abs(best.gap);
  for (const int t : near) {
    if (is_beyond(mesh, t, p, std::max(least, kOn))) continue;
    const Beside as = beside(mesh, t, p);
    const bool same_side = (as.along < 0) == (facing < 0) && std::abs(as.along) > std::abs(facing) - kSame;
    if (least > kOn ? as.distance > least + kSame || !same_side : as.distance > kOn) continue;
    one = one && (as.normal - best.normal).squaredNorm() < kSame * kSame;
    sum += angle_at(as.nearest, mesh.triangles()[t], mesh.vertices()) * as.normal;
  }
  if (one || sum.norm() < kOn) return;
  best.normal = sum.normalized();
  best.point = p - best.gap * best.normal;
}

}  // namespace

std::optional<NearestSurface> nearest_surface(const TriangleMesh& mesh, const Vec3& p, double reach, std::vector<int>& scratch) {
  scratch.clear();
  mesh.query({p.array() - reach, p.array() + reach}, scratch);
  std::optional<NearestSurface> best;
  double least = reach, facing = 0;
  bool tied = false;
  for (const int t : scratch) {
    if (is_beyond(mesh, t, p, std::max(least, kOn))) continue;
    const Beside it = beside(mesh, t, p);
    const bool nearer = it.distance < least - kSame;
    const bool same = best && it.distance < least + kSame;
    const bool on_too = best && least <= kOn && it.distance <= kOn;
    tied = nearer ? on_too : tied || same || on_too;
    if (!nearer && !(same && std::abs(it.along) > std::abs(facing))) continue;
    least = std::min(least, it.distance);
    facing = it.along;
    best = NearestSurface{it.nearest, it.normal, it.along < 0 ? -it.distance : it.distance, t};
  }
  if (tied) take_the_mean(mesh, scratch, p, *best, facing);
  return best;
}

namespace {

void add_unlike(std::vector<Vec3>& normals, const Vec3& n) {
  constexpr double kAlike = 0.02;  // [rad]
  for (const Vec3& other : normals)
    if ((other - n).norm() < kAlike) return;
  normals.push_back(n);
}

/// What a triangle adds to the normals of a point of its edge: its own and, where nothing joins it there, away from it and behind.
void add_normals(const TriangleMesh& mesh, int triangle, std::size_t edge, std::vector<Vec3>& normals) {
  const Vec3& n = mesh.face_normals()[triangle];
  add_unlike(normals, n);
  const int e = static_cast<int>(edge);
  if (mesh.edge_kind(triangle, e) != EdgeKind::open) return;
  const Triangle& v = mesh.triangles()[triangle];
  add_unlike(normals, (mesh.vertices()[v[(edge + 1) % 3]] - mesh.vertices()[v[edge]]).cross(n).normalized());
  add_unlike(normals, -n);
}

RepresentativePoint at_vertex(const TriangleMesh& mesh, int vertex) {
  RepresentativePoint out{mesh.vertices()[vertex], {}};
  for (const int t : mesh.triangles_at(vertex))
    for (std::size_t i = 0; i < 3; ++i)
      if (mesh.triangles()[t][i] == vertex || mesh.triangles()[t][(i + 1) % 3] == vertex) add_normals(mesh, t, i, out.normals);
  return out;
}

}  // namespace

std::vector<RepresentativePoint> representative_points(const TriangleMesh& mesh, double spacing, PointsOf of, WithNormals with) {
  const Vec3 centre = 0.5 * (mesh.bounds().lower + mesh.bounds().upper);
  std::map<std::array<int, 3>, RepresentativePoint> cubes;
  const auto offer = [&](const RepresentativePoint& point) {
    const Eigen::Vector3i cube = ((point.p - centre) / spacing).array().floor().cast<int>();
    const auto [at, fresh] = cubes.try_emplace({cube.x(), cube.y(), cube.z()}, point);
    if (fresh) return;
    if ((point.p - centre).squaredNorm() > (at->second.p - centre).squaredNorm()) at->second.p = point.p;
    for (const Vec3& n : point.normals) add_unlike(at->second.normals, n);
  };
  const bool normals = with == WithNormals::yes;
  for (int v = 0; v < static_cast<int>(mesh.vertices().size()); ++v)
    offer(normals ? at_vertex(mesh, v) : RepresentativePoint{mesh.vertices()[v], {}});
  for (int t = 0; of == PointsOf::vertices_and_edges && t < static_cast<int>(mesh.triangles().size()); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const int edge = static_cast<int>(i);
      if (!felt_by_round(mesh.edge_kind(t, edge))) continue;
      const Triangle& v = mesh.triangles()[t];
      const Vec3 &from = mesh.vertices()[v[i]], &to = mesh.vertices()[v[(i + 1) % 3]];
      RepresentativePoint point;
      if (normals) add_normals(mesh, t, i, point.normals);
      if (const int other = mesh.neighbour(t, edge); normals && other >= 0) add_unlike(point.normals, mesh.face_normals()[other]);
      const double parts = std::ceil((to - from).norm() / spacing);
      for (double k = 1; k < parts; ++k) {
        point.p = from + k / parts * (to - from);
        offer(point);
      }
    }
  std::vector<RepresentativePoint> out;
  for (const auto& entry : cubes) out.push_back(entry.second);
  return out;
}

Vec3 nearest_in_cone(const std::vector<Vec3>& normals, const Vec3& d) {
  constexpr double kAlong = 0.9999;  // [-] cosine: within by all but a degree, without a look at all pairs
  if (std::any_of(normals.begin(), normals.end(), [&](const Vec3& n) { return n.dot(d) > kAlong; })) return d;
  // on the cone's border two normals at most take part
  Vec3 nearest = Vec3::Zero();
  const auto offer = [&](const Vec3& p) {
    if ((p - d).squaredNorm() < (nearest - d).squaredNorm()) nearest = p;
  };
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double along = normals[i].dot(d);
    if (along > 0) offer(along * normals[i]);
    for (std::size_t k = i + 1; k < normals.size(); ++k) {
      const double other = normals[k].dot(d), c = normals[i].dot(normals[k]);
      const double a = along - c * other, b = other - c * along, size = 1 - c * c;
      if (a > 0 && b > 0 && size > 0) offer((a * normals[i] + b * normals[k]) / size);
    }
  }
  // all normals lie behind the plane through the nearest point of the border, or d is within
  constexpr double kBehind = 1e-9;
  for (const Vec3& n : normals)
    if (n.dot(d - nearest) > kBehind) return d;
  return nearest;
}

void keep_spread(std::vector<SurfaceContact>& contacts, std::size_t most) {
  if (contacts.size() <= most) return;
  for (std::size_t k = 0; k < most; ++k) {
    std::size_t next = k;
    double best = -1e300;
    for (std::size_t i = k; i < contacts.size(); ++i) {
      double merit = -contacts[i].gap;
      if (k > 0) {
        double nearest = 1e300;
        for (std::size_t j = 0; j < k; ++j) nearest = std::min(nearest, (contacts[i].p_a - contacts[j].p_a).norm());
        merit = nearest - 10 * contacts[i].gap;  // a centimetre of depth counts like a decimetre of distance
      }
      if (merit > best) best = merit, next = i;
    }
    std::swap(contacts[k], contacts[next]);
  }
  contacts.resize(most);
}

}  // namespace engine
