// For each triangle near the body, in the axes of the mesh and counted from the body's centre, so that where on a flat panel it is
// met does not change a last digit of how:
//   face    the support point against the face normal, if it projects into the triangle (eq. (70) with the point inside, as asked)
//   edge    the normal m of the cone between the faces of a convex edge whose support point projects onto the edge: there the
//           distance m.(p - q) of the support point p from a point q of the edge is largest. There is one just where the support
//           points of both faces project beyond the edge, so that nothing falls between faces and edges at whatever gap
//   vertex  the same at a corner, for normals in the cone of its edges; looked at where a support point projects beyond an edge's
//           end
// Flat and concave edges are never felt, and a convex edge only inside its cone, so a sheet of triangles acts as one surface; a
// round body feels the slightest convex edge, a flat-sided one only what stands out of the plane.
//
// Of a body with flat sides, whose support points jump, an edge is met at the point p where the gauge N is least, with normal
// -grad N(p) if that lies in the cone; gap from the support function, f(m) = m.(c - p) - h(m), second order in m's error.
#include "engine/geometry/mesh_touch.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>

#include "engine/math/roots.h"

namespace engine {
namespace {

constexpr double kBorder = 1e-6;  // [-] barycentric tolerance: on the border counts as inside

bool inside(const MeshTouch& s, int triangle, const Vec3& p) {
  const Triangle& t = s.mesh.triangles()[triangle];
  const Vec3& n = s.mesh.face_normals()[triangle];
  const Vec3 a = s.vertex(t[0]), b = s.vertex(t[1]), c = s.vertex(t[2]);
  const double area = n.dot((b - a).cross(c - a));
  return n.dot((b - a).cross(p - a)) >= -kBorder * area && n.dot((c - b).cross(p - b)) >= -kBorder * area &&
         n.dot((a - c).cross(p - c)) >= -kBorder * area;
}

constexpr double kDeep = 0.1;       // [-] of the half thickness
constexpr double kRounding = 1e-9;  // [-]
constexpr double kBefore = 0.98;    // [-] of the half widths: what lies before a side, away from its rounded rim

/// How far along one of its sides' normals a point lies within the body or behind it [m]; 0 where that is not deep, or beside it.
double deep_by(const HyperEllipsoid& shape, int side, const Vec3& p_A) {
  const int axis = side / 2;
  const double way = shape.semi_axes[axis] - outward_of(side).dot(p_A);
  for (int k = 0; k < 3; ++k)
    if (k != axis && std::abs(p_A[k]) > (kBefore + kRounding) * shape.semi_axes[k]) return 0;
  return way > kDeep * shape.semi_axes[axis] ? way : 0;
}

/// The nearest of the sides that the mesh has come in through to a point deep in the body, or behind it; none if it is not. The
/// gauge forgets them: deep in a wall its foot may be nearer, and behind it nothing is left.
std::optional<int> entered_through(const MeshTouch& s, const Vec3& p_A) {
  std::optional<int> out;
  double nearest = std::numeric_limits<double>::infinity();
  for (int side = 0; side < 6; ++side) {
    if (!(s.entered >> side & 1)) continue;
    if (const double way = deep_by(s.shape, side, p_A); way > 0 && way < nearest) nearest = way, out = side;
  }
  return out;
}

/// Lists the contact at such a point, if one of the triangles at it looks that way: what lies there, held flat by its side.
void hold_deep_point(MeshTouch& s, const Vec3& p, int side, std::initializer_list<int> triangles) {
  constexpr double kFaces = 0.1;  // [-] cosine
  const Vec3 outward = s.X_MA.q * outward_of(side);
  const auto faces = [&](int t) { return t >= 0 && s.mesh.face_normals()[static_cast<std::size_t>(t)].dot(outward) < -kFaces; };
  if (std::none_of(triangles.begin(), triangles.end(), faces)) return;
  const double gap = outward.dot(p) - s.shape.semi_axes[side / 2];
  if (gap < s.margin && gap >= s.least) s.scratch.candidates.push_back({p - gap * outward, p, -outward, gap});
}

/// Where on an edge, of what lies before a side, it is deepest.
std::optional<double> deepest_on_edge(const HyperEllipsoid& shape, int side, const Vec3& from_A, const Vec3& along_A) {
  double first = 0, last = 1;
  for (int k = 0; k < 3; ++k) {
    if (k == side / 2 || along_A[k] == 0) continue;
    const double reach = kBefore * shape.semi_axes[k];
    const double a = (-reach - from_A[k]) / along_A[k], b = (reach - from_A[k]) / along_A[k];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  if (first > last) return std::nullopt;
  return outward_of(side).dot(along_A) < 0 ? last : first;
}

/// The contact at a mesh point p (on an edge or a vertex) with normal against the gauge gradient there.
bool point_contact(const MeshTouch& s, const Vec3& p, SurfaceContact& c) {
  const Vec3 p_A = s.X_MA.q.conjugate() * p;
  const Vec3 g = gauge_gradient(s.shape, p_A);
  if (g.squaredNorm() == 0) return false;
  const Vec3 m_A = -g.normalized();
  c.gap = -m_A.dot(p_A) - support_value(s.shape, m_A);
  c.normal = s.X_MA.q * m_A;
  c.p_b = p;
  c.p_a = p + c.gap * c.normal;
  return c.gap < s.margin && c.gap >= s.least;
}

/// Parameter of the edge point with the least gauge: convex, so safeguarded Newton cannot fail.
double least_gauge(const HyperEllipsoid& shape, const Vec3& from_A, const Vec3& along_A) {
  auto slope = [&](double t) { return gauge_gradient(shape, from_A + t * along_A).dot(along_A); };
  if (slope(0) >= 0) return 0;
  if (slope(1) <= 0) return 1;
  return math::newton({0, 1}, 0.5, 40, 1e-12, 1e-13, [&](double t) {
    return std::pair(slope(t), along_A.dot(gauge_hessian(shape, from_A + t * along_A) * along_A));
  });
}

/// Does the normal lean away from every edge at the vertex, by more than -slack [-], and from the back of no face? Of those
/// triangles that count.
template <class Counts>
bool in_cone_of_vertex(const TriangleMesh& mesh, int vertex, const Vec3& normal, double slack, const Counts& counts) {
  const Vec3& at = mesh.vertices()[vertex];
  for (const int triangle : mesh.triangles_at(vertex)) {
    if (!counts(triangle)) continue;
    for (const std::int32_t other : mesh.triangles()[triangle])
      if (other != vertex && normal.dot((mesh.vertices()[other] - at).normalized()) > slack) return false;
    if (normal.dot(mesh.face_normals()[triangle]) < 0) return false;
  }
  return true;
}

/// Where the body reaches farthest against a normal.
struct Reached {
  Vec3 point;       // [m] mesh axes, from the centre
  Support support;  // in body axes
};
Reached reached(const MeshTouch& s, const Vec3& normal) {
  const Support support = engine::support(s.shape, s.X_MA.q.conjugate() * -normal);
  return {s.X_MA.q * support.point, support};
}

}  // namespace

const SmallVector<Vec3, 5>& MeshTouch::points_against(const Vec3& normal) {
  if (normal == last_normal) return last_points;
  last_normal = normal;
  last_points.clear();
  const Vec3 down_A = X_MA.q.conjugate() * -normal;
  last_points.push_back(X_MA.q * support_point(shape, down_A));
  if (flat())
    for (const Vec3& direction : corner_directions(shape, down_A)) last_points.push_back(X_MA.q * support_point(shape, direction));
  return last_points;
}

void touch_face(MeshTouch& s, int triangle) {
  const Vec3& n = s.mesh.face_normals()[triangle];
  const double offset = n.dot(s.vertex(s.mesh.triangles()[triangle][0]));
  std::uint32_t rank = kDeepest;  // first, then the corners
  const SmallVector<Vec3, 5>& points = s.points_against(n);
  s.scratch.points.push_back(points[0]);
  for (const Vec3& p : points) {
    const double gap = n.dot(p) - offset;
    if (gap < s.margin && gap >= s.least && inside(s, triangle, p - gap * n))
      s.scratch.candidates.push_back({p, p - gap * n, n, gap, rank});
    rank = rank == kDeepest ? 1 : rank + 1;
  }
}

void touch_edge_round(MeshTouch& s, int triangle, int edge) {
  constexpr double kTight = 1e-12, kClose = 1e-9;       // [-]
  constexpr double kFin = -1 + 1e-8, kHairShort = 1e4;  // [-]
  const Triangle& t = s.mesh.triangles()[triangle];
  const int from = t[static_cast<std::size_t>(edge)], to = t[static_cast<std::size_t>((edge + 1) % 3)];
  const Vec3 start = s.vertex(from);
  const Vec3 along = s.mesh.vertices()[to] - s.mesh.vertices()[from];
  const Vec3& n = s.mesh.face_normals()[triangle];
  const Vec3 out = along.cross(n).normalized();  // in the face, across the edge
  const Vec3 here = s.point_of_near(triangle);
  const double beyond_this = out.dot(here - start);
  if (beyond_this <= 0) return;
  // the cone: cos(angle) n + sin(angle) out, from this face to the other; of a border to the edge of the sheet. Slope of the
  // distance along it: where it is zero the point reached lies over the edge
  const int other = s.mesh.neighbour(triangle, edge);
  Vec3 normal = other >= 0 ? s.mesh.face_normals()[other] : out;
  Vec3 point = other >= 0 && s.is_near(other) ? s.point_of_near(other) : reached(s, normal).point;
  const double cosine = n.dot(normal), sine = out.dot(normal);
  const double beyond_other = (cosine * out - sine * n).dot(point - start);
  if (beyond_other >= 0) return;
  // by x, the tangent of half the angle: no sines. A thin fin's other face stands a hair short of half a turn
  const double half_turn = cosine > kFin ? sine / (1 + cosine) : kHairShort;
  const double first = half_turn * beyond_this / (beyond_this - beyond_other);
  math::newton({0, half_turn}, first, 60, kTight, kClose, [&](double x) {
    const double scale = 1 / (1 + x * x), c = (1 - x * x) * scale, sn = 2 * x * scale;
    normal = c * n + sn * out;
    const Vec3 across = c * out - sn * n;
    const Reached here_too = reached(s, normal);
    point = here_too.point;
    const Vec3 across_A = s.X_MA.q.conjugate() * across;
    const Mat3 H = support_hessian(s.shape, s.X_MA.q.conjugate() * -normal, here_too.support);
    const double turning = normal.dot(point - start) + across_A.dot(H * across_A);
    return std::pair(-across.dot(point - start), 2 * scale * turning);
  });
  const double at = along.dot(point - start) / along.squaredNorm();
  const double gap = normal.dot(point - start);
  if (gap >= s.margin) return;  // a vertex is no nearer
  if (at <= 0 || at >= 1) {
    s.scratch.beyond.push_back({at <= 0 ? from : to, normal});
    return;
  }
  if (gap >= s.least) s.scratch.candidates.push_back({point, point - gap * normal, normal, gap});
}

void touch_vertex_round(MeshTouch& s, const VertexTouch& guess) {
  constexpr double kTight = 1e-10;  // [m]
  const Vec3 vertex = s.vertex(guess.vertex);
  SurfaceContact c;
  c.normal = guess.normal;
  Reached at = reached(s, c.normal);
  c.gap = c.normal.dot(at.point - vertex);
  for (int k = 0; k < 20; ++k) {
    const Vec3 aside = at.point - vertex - c.gap * c.normal;
    if (aside.norm() < kTight) break;
    // the support point moves by -H dm, aside by -(H + gap) dm
    const Mat3 R = s.X_MA.q.toRotationMatrix();
    const Mat3 H = R * support_hessian(s.shape, s.X_MA.q.conjugate() * -c.normal, at.support) * R.transpose();
    const Mat3 along = c.normal * c.normal.transpose(), across = Mat3::Identity() - along;
    Eigen::LDLT<Mat3> A(H + c.gap * across + along);
    // deeper than the body is round there: uphill all the same
    if (!A.isPositive() || A.vectorD().minCoeff() < 1e-6)
      A.compute(H + std::max(c.gap, 0.0) * across + along + 1e-6 * Mat3::Identity());
    Vec3 turn = across * A.solve(aside);
    if (turn.norm() > 0.3) turn *= 0.3 / turn.norm();
    bool better = false;
    for (int halving = 0; halving < 8 && !better; ++halving, turn *= 0.5) {
      const Vec3 normal = (c.normal + turn).normalized();
      const Reached next = reached(s, normal);
      const double gap = normal.dot(next.point - vertex);
      if (gap <= c.gap) continue;
      better = true;
      c.normal = normal;
      c.gap = gap;
      at = next;
    }
    if (!better) break;
  }
  if (c.gap >= s.margin || c.gap < s.least) return;
  c.p_b = vertex;
  c.p_a = vertex + c.gap * c.normal;
  constexpr double kAside = 1e-6;  // [-] what is left of Newton, on the border between a corner and its edge
  if (in_cone_of_vertex(s.mesh, guess.vertex, c.normal, kAside, [](int) { return true; })) s.scratch.candidates.push_back(c);
}

void touch_edge_flat(MeshTouch& s, int triangle, int edge) {
  const Triangle& t = s.mesh.triangles()[triangle];
  const Vec3 from = s.vertex(t[edge]);
  const Vec3 along = s.mesh.vertices()[t[(edge + 1) % 3]] - s.mesh.vertices()[t[edge]];
  const Quat q_AM = s.X_MA.q.conjugate();
  const int other = s.mesh.neighbour(triangle, edge);
  for (int side = 0; side < 6; ++side) {
    if (!(s.entered >> side & 1)) continue;
    const auto deepest = deepest_on_edge(s.shape, side, q_AM * from, q_AM * along);
    if (deepest && entered_through(s, q_AM * (from + *deepest * along)) == side)
      hold_deep_point(s, from + *deepest * along, side, {triangle, other});
  }
  const double at = least_gauge(s.shape, q_AM * from, q_AM * along);
  if (at <= 0 || at >= 1) return;  // a vertex's business
  if (entered_through(s, q_AM * (from + at * along))) return;
  SurfaceContact c;
  if (!point_contact(s, from + at * along, c)) return;
  // inside the cone of the edge: not over either face
  const Vec3 inward = s.mesh.face_normals()[triangle].cross(along).normalized();
  if (c.normal.dot(inward) > 1e-9) return;
  if (other >= 0 && c.normal.dot(-s.mesh.face_normals()[other].cross(along).normalized()) > 1e-9) return;
  if (other < 0 && c.normal.dot(s.mesh.face_normals()[triangle]) < 0) return;  // the back of an open sheet
  s.scratch.candidates.push_back(c);
}

void touch_vertex_flat(MeshTouch& s, int vertex) {
  SurfaceContact c;
  if (entered_through(s, s.X_MA.q.conjugate() * s.vertex(vertex))) return;  // its edges end there
  if (point_contact(s, s.vertex(vertex), c) &&
      in_cone_of_vertex(s.mesh, vertex, c.normal, 1e-9, [&s](int t) { return s.is_near(t); }))
    s.scratch.candidates.push_back(c);
}

}  // namespace engine
