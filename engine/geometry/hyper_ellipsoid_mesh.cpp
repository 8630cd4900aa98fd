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
#include "engine/geometry/hyper_ellipsoid_mesh.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/face_corners.h"
#include "engine/math/functions.h"
#include "engine/math/roots.h"

namespace engine {
namespace {

constexpr double kLookAhead = 0.15;  // [m] how far beyond the margin a free neighbourhood is told

constexpr double kFromBehind = 0.25;   // [-] of the body: deeper than can be by so much is not this side
constexpr double kBorder = 1e-6;       // [-] barycentric tolerance: on the border counts as inside
constexpr double kCluster = 0.985;     // [-] cosine of 10 degrees
constexpr int kKeep = 4;               // contacts of one body with one mesh; one more where a flat side's deepest point counts
constexpr std::uint32_t kDeepest = 5;  // rank of a face's deepest point after its corners 1 to 4, as on a plane; 0: edge or vertex

struct Scene {
  const HyperEllipsoid& shape;
  Pose X_MA;  // body in the mesh frame
  const TriangleMesh& mesh;
  double margin;
  double least;                           // [m] smallest gap that can be of this side
  std::vector<SurfaceContact>& out;       // all points: mesh axes, from the body's centre
  SmallVector<Vec3, 5> last_points = {};  // [m]
  Vec3 last_normal = Vec3::Zero();

  Vec3 vertex(int v) const { return mesh.vertices()[static_cast<std::size_t>(v)] - X_MA.p; }

  /// The deepest point against a face of this normal and, of a body with flat sides, the corners of its side, of rank 1 to 4: those
  /// of the last normal are kept, for a panel may have thousands of triangles.
  const SmallVector<Vec3, 5>& points_against(const Vec3& normal) {
    if (normal == last_normal) return last_points;
    last_normal = normal;
    last_points.clear();
    const Vec3 down_A = X_MA.q.conjugate() * -normal;
    last_points.push_back(X_MA.q * support_point(shape, down_A));
    if (shape.exponent >= kFlatExponent)
      for (const Vec3& direction : corner_directions(shape, down_A))
        last_points.push_back(X_MA.q * support_point(shape, direction));
    return last_points;
  }
};

bool inside(const Scene& s, int triangle, const Vec3& p) {
  const Triangle& t = s.mesh.triangles()[triangle];
  const Vec3& n = s.mesh.face_normals()[triangle];
  const Vec3 a = s.vertex(t[0]), b = s.vertex(t[1]), c = s.vertex(t[2]);
  const double area = n.dot((b - a).cross(c - a));
  return n.dot((b - a).cross(p - a)) >= -kBorder * area && n.dot((c - b).cross(p - b)) >= -kBorder * area &&
         n.dot((a - c).cross(p - c)) >= -kBorder * area;
}

void touch_face(Scene& s, int triangle) {
  const Vec3& n = s.mesh.face_normals()[triangle];
  const double offset = n.dot(s.vertex(s.mesh.triangles()[triangle][0]));
  std::uint32_t rank = kDeepest;  // first, then the corners
  for (const Vec3& p : s.points_against(n)) {
    const double gap = n.dot(p) - offset;
    if (gap < s.margin && gap >= s.least && inside(s, triangle, p - gap * n)) s.out.push_back({p, p - gap * n, n, gap, rank});
    rank = rank == kDeepest ? 1 : rank + 1;
  }
}

/// The contact at a mesh point p (on an edge or a vertex) with normal against the gauge gradient there.
bool point_contact(const Scene& s, const Vec3& p, SurfaceContact& c) {
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
Reached reached(const Scene& s, const Vec3& normal) {
  const Support support = engine::support(s.shape, s.X_MA.q.conjugate() * -normal);
  return {s.X_MA.q * support.point, support};
}

/// Of a round body. Where the point reached projects beyond an end, that vertex is worth a look with the normal found.
void touch_edge_round(Scene& s, int triangle, int edge, std::vector<VertexTouch>& beyond) {
  constexpr double kTight = 1e-12;  // [-], [m]
  const Triangle& t = s.mesh.triangles()[triangle];
  const int from = t[static_cast<std::size_t>(edge)], to = t[static_cast<std::size_t>((edge + 1) % 3)];
  const Vec3 start = s.vertex(from);
  const Vec3 along = s.mesh.vertices()[to] - s.mesh.vertices()[from];
  const Vec3& n = s.mesh.face_normals()[triangle];
  const Vec3 out = along.cross(n).normalized();  // in the face, across the edge
  const double beyond_this = out.dot(s.points_against(n)[0] - start);
  if (beyond_this <= 0) return;
  // the cone: cos(angle) n + sin(angle) out, from this face to the other; of a border to the edge of the sheet
  const int other = s.mesh.neighbour(triangle, edge);
  const Vec3 n_far = other >= 0 ? s.mesh.face_normals()[other] : out;
  const double widest = math::atan2(out.dot(n_far), n.dot(n_far));
  // slope of the distance along the cone: where it is zero the point reached lies over the edge
  Vec3 normal;
  Vec3 point;
  auto slope = [&](double angle) {
    const double c = math::cos(angle), sn = math::sin(angle);
    normal = c * n + sn * out;
    point = reached(s, normal).point;
    return (c * out - sn * n).dot(point - start);
  };
  const double beyond_other = slope(widest);
  if (beyond_other >= 0) return;
  math::illinois(
      {0, widest}, -beyond_this, -beyond_other, 60, kTight, [&](double angle) { return -slope(angle); },
      [](double f) { return std::abs(f) < kTight; });
  const double at = along.dot(point - start) / along.squaredNorm();
  const double gap = normal.dot(point - start);
  if (gap >= s.margin) return;  // a vertex is no nearer
  if (at <= 0 || at >= 1) {
    beyond.push_back({at <= 0 ? from : to, normal});
    return;
  }
  if (gap >= s.least) s.out.push_back({point, point - gap * normal, normal, gap});
}

/// The normal whose support point lies over the vertex, from a guess: Newton on the distance, which is largest there.
void touch_vertex_round(Scene& s, const VertexTouch& guess) {
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
  if (in_cone_of_vertex(s.mesh, guess.vertex, c.normal, kAside, [](int) { return true; })) s.out.push_back(c);
}

/// Of a body with flat sides.
void touch_edge_flat(Scene& s, int triangle, int edge) {
  const Triangle& t = s.mesh.triangles()[triangle];
  const Vec3 from = s.vertex(t[edge]);
  const Vec3 along = s.mesh.vertices()[t[(edge + 1) % 3]] - s.mesh.vertices()[t[edge]];
  const Quat q_AM = s.X_MA.q.conjugate();
  const double at = least_gauge(s.shape, q_AM * from, q_AM * along);
  if (at <= 0 || at >= 1) return;  // a vertex's business
  SurfaceContact c;
  if (!point_contact(s, from + at * along, c)) return;
  // inside the cone of the edge: not over either face
  const Vec3 inward = s.mesh.face_normals()[triangle].cross(along).normalized();
  if (c.normal.dot(inward) > 1e-9) return;
  const int other = s.mesh.neighbour(triangle, edge);
  if (other >= 0 && c.normal.dot(-s.mesh.face_normals()[other].cross(along).normalized()) > 1e-9) return;
  if (other < 0 && c.normal.dot(s.mesh.face_normals()[triangle]) < 0) return;  // the back of an open sheet
  s.out.push_back(c);
}

template <class IsNear>
void touch_vertex_flat(Scene& s, int vertex, const IsNear& is_near) {
  SurfaceContact c;
  if (point_contact(s, s.vertex(vertex), c) && in_cone_of_vertex(s.mesh, vertex, c.normal, 1e-9, is_near)) s.out.push_back(c);
}

std::uint32_t key_of(const SurfaceContact& c, const Quat& q_MA, double exponent) {
  // main direction of the normal and, of a body with corners, which of a face's points it is, or else the octant of the point:
  // steady while the body slides from triangle to triangle, and while a round one rolls
  const Vec3 p_A = exponent < kFlatExponent ? Vec3(Vec3::Zero()) : Vec3(q_MA.conjugate() * c.p_a);
  int axis = 0;
  c.normal.cwiseAbs().maxCoeff(&axis);
  const bool of_face = exponent >= kFlatExponent && c.key > 0;
  const int octant = of_face ? static_cast<int>(c.key) : (p_A.x() > 0) + 2 * (p_A.y() > 0) + 4 * (p_A.z() > 0);
  return static_cast<std::uint32_t>(octant + 8 * (2 * axis + (c.normal[axis] > 0)));
}

/// Where all four corners of a flat side are above triangles of one plane, on whichever of them, they stand for the whole side. Its
/// deepest point, which jumps, is left out if it is no deeper, and so are edges and vertices that do not stand out of the plane:
/// borders, where triangles were missing or double. Over the border of a sheet a corner is missing, and all of them count.
void let_four_corners_speak(std::vector<SurfaceContact>& found) {
  constexpr double kFlush = 1e-6;  // [m]
  constexpr std::uint32_t kAll = 0b11110;
  constexpr double kIdle = std::numeric_limits<double>::infinity();
  for (const SurfaceContact& deepest : found) {
    if (deepest.key != kDeepest) continue;
    const auto on_its_plane = [&](const SurfaceContact& c) { return (c.normal - deepest.normal).squaredNorm() < 1e-20; };
    std::uint32_t corners = 0;  // bit r: the corner of rank r is there
    double lowest = kIdle;
    for (const SurfaceContact& c : found) {
      if (c.key == 0 || c.key == kDeepest || !on_its_plane(c)) continue;
      corners |= 1u << c.key;
      lowest = std::min(lowest, c.gap);
    }
    if (corners != kAll) continue;
    for (SurfaceContact& c : found) {
      const bool idle_deepest = c.key == kDeepest && on_its_plane(c) && c.gap >= lowest - kNoDeeper;
      const bool flush = c.key == 0 && c.normal.dot(deepest.normal) > kCluster && deepest.normal.dot(c.p_b - deepest.p_b) < kFlush;
      if (idle_deepest || flush) c.gap = kIdle;
    }
  }
  std::erase_if(found, [](const SurfaceContact& c) { return c.gap == kIdle; });
}

/// Two of the points that stand for one flat side of a body on one plane: all of them are kept there, however near.
bool corners_of_one_face(const SurfaceContact& a, const SurfaceContact& b) {
  return a.key > 0 && b.key > 0 && a.key != b.key && (a.normal - b.normal).squaredNorm() < 1e-20;
}

/// Deepest first; then, within a bundle of like normals, only points well apart; at most `most`.
void keep_the_telling(std::vector<SurfaceContact>& found, double apart, int most, ContactPoints& out) {
  std::sort(found.begin(), found.end(), [](const SurfaceContact& a, const SurfaceContact& b) {
    if (a.gap != b.gap) return a.gap < b.gap;
    return std::lexicographical_compare(a.p_b.data(), a.p_b.data() + 3, b.p_b.data(), b.p_b.data() + 3);
  });
  for (const SurfaceContact& c : found) {
    if (out.size() == most) return;
    const bool said = std::any_of(out.begin(), out.end(), [&](const SurfaceContact& k) {
      return k.normal.dot(c.normal) > kCluster && (k.p_a - c.p_a).norm() < apart && !corners_of_one_face(k, c);
    });
    if (!said) out.push_back(c);
  }
}

}  // namespace

void reserve(MeshContactScratch& scratch, const TriangleMesh& mesh) {
  const std::size_t count = mesh.triangles().size();
  scratch.triangles.reserve(count);
  if (scratch.seen.size() < count) scratch.seen.resize(count, 0);
  scratch.vertices.reserve(6 * count);
  scratch.beyond.reserve(std::min<std::size_t>(3 * count, 4096));
  scratch.candidates.reserve(std::min<std::size_t>(4 * count, 4096));
}

void contacts_with_mesh(const HyperEllipsoid& shape, const Pose& X_WA, const TriangleMesh& mesh, const Pose& X_WM, double margin,
                        double least, MeshContactScratch& scratch, ContactPoints& out, double passed_by) {
  out.clear();
  const Pose X_MA = X_WM.inverse() * X_WA;
  // the sphere around the body first: most pairs are far apart
  const double radius = shape.semi_axes.norm() + margin;
  scratch.apart = (X_MA.p - mesh.bounds().upper).cwiseMax(mesh.bounds().lower - X_MA.p).maxCoeff() - radius + margin;
  if (scratch.apart > margin) return;
  scratch.apart = 0;
  const Vec3 half = aabb_half_widths(shape, X_MA.q);
  // in the middle of a panel only the triangles count that one of the points lies above that touch_face will look at
  constexpr double kSlack = 1e-5;  // [m] for normals that agree to rounding
  bool passed = false;
  Scene scene{shape, X_MA, mesh, margin, least - kFromBehind * shape.semi_axes.minCoeff(), scratch.candidates};
  auto pass = [&](const Vec3& n, double offset, const Aabb& branch) {
    for (const Vec3& p : scene.points_against(n)) {
      const Vec3 at = X_MA.p + p, on_plane = at - (n.dot(at) - offset) * n;
      const bool above =
          (on_plane.array() > branch.lower.array() - kSlack).all() && (on_plane.array() < branch.upper.array() + kSlack).all();
      if (above) return false;
    }
    passed = true;
    return true;
  };
  auto look = [&](double around) {
    scratch.triangles.clear();
    mesh.query({X_MA.p - half - Vec3::Constant(around), X_MA.p + half + Vec3::Constant(around)}, scratch.triangles, pass);
    return passed || !scratch.triangles.empty();
  };
  if (!look(margin)) {
    scratch.apart = look(margin + kLookAhead) ? margin : margin + kLookAhead;
    return;
  }

  // away with triangles whose plane the body does not reach, or whose back its centre has passed
  const Mat3 R_AM = X_MA.q.conjugate().toRotationMatrix();
  Vec3 last_normal = Vec3::Zero();  // many triangles of a panel share theirs
  double h = 0;
  std::erase_if(scratch.triangles, [&](int t) {
    const Vec3& n = mesh.face_normals()[t];
    const double height = n.dot(X_MA.p - mesh.vertices()[mesh.triangles()[t][0]]);
    if (height > radius) return true;
    if (n != last_normal) {
      last_normal = n;
      h = support_value(shape, R_AM * n);
    }
    return height - h > margin || height < -passed_by * h;
  });
  if (scratch.seen.size() < mesh.triangles().size()) scratch.seen.resize(mesh.triangles().size(), 0);
  if (++scratch.call == 0) {  // after four thousand million calls
    std::fill(scratch.seen.begin(), scratch.seen.end(), 0u);
    scratch.call = 1;
  }
  for (const int t : scratch.triangles) scratch.seen[static_cast<std::size_t>(t)] = scratch.call;
  const auto is_near = [&](int t) { return scratch.seen[static_cast<std::size_t>(t)] == scratch.call; };

  scratch.candidates.clear();
  scratch.vertices.clear();
  scratch.beyond.clear();
  const bool flat = shape.exponent >= kFlatExponent;
  for (const int t : scratch.triangles) {
    touch_face(scene, t);
    for (int e = 0; e < 3; ++e) {
      if (!(flat ? felt(mesh.edge_kind(t, e)) : felt_by_round(mesh.edge_kind(t, e)))) continue;
      const int other = mesh.neighbour(t, e);
      if (other >= 0 && other < t && is_near(other)) continue;  // once for both
      if (flat) {
        touch_edge_flat(scene, t, e);
        for (const int end : {e, (e + 1) % 3}) scratch.vertices.push_back(mesh.triangles()[t][end]);
      } else {
        touch_edge_round(scene, t, e, scratch.beyond);
      }
    }
  }
  std::sort(scratch.vertices.begin(), scratch.vertices.end());
  scratch.vertices.erase(std::unique(scratch.vertices.begin(), scratch.vertices.end()), scratch.vertices.end());
  for (const int v : scratch.vertices) touch_vertex_flat(scene, v, is_near);

  // more than one edge may lead to a vertex: the first found will do
  std::sort(scratch.beyond.begin(), scratch.beyond.end(), [](const VertexTouch& a, const VertexTouch& b) {
    if (a.vertex != b.vertex) return a.vertex < b.vertex;
    return std::lexicographical_compare(a.normal.data(), a.normal.data() + 3, b.normal.data(), b.normal.data() + 3);
  });
  for (std::size_t i = 0; i < scratch.beyond.size(); ++i)
    if (i == 0 || scratch.beyond[i].vertex != scratch.beyond[i - 1].vertex) touch_vertex_round(scene, scratch.beyond[i]);

  if (flat) let_four_corners_speak(scratch.candidates);
  keep_the_telling(scratch.candidates, 0.25 * shape.semi_axes.minCoeff(), flat ? kKeep + 1 : kKeep, out);
  // in the order of a plane, so that a sheet of triangles is solved as one
  if (flat)
    std::sort(out.begin(), out.end(), [](const SurfaceContact& a, const SurfaceContact& b) {
      if (a.key != b.key) return a.key < b.key;
      return std::lexicographical_compare(a.p_b.data(), a.p_b.data() + 3, b.p_b.data(), b.p_b.data() + 3);
    });
  std::uint32_t used = 0;
  for (SurfaceContact& c : out) {
    scratch.apart = std::min(scratch.apart, c.gap);
    c.key = key_of(c, X_MA.q, shape.exponent) + 64 * used++;
    c.p_a = X_WA.p + X_WM.q * c.p_a;
    c.p_b = X_WA.p + X_WM.q * c.p_b;
    c.normal = X_WM.q * c.normal;
  }
  // the running number only tells apart what shares a key: give it back where the key is unique
  for (SurfaceContact& c : out) {
    const std::uint32_t plain = c.key % 64;
    if (std::count_if(out.begin(), out.end(), [&](const SurfaceContact& o) { return o.key % 64 == plain; }) == 1) c.key = plain;
  }
}

}  // namespace engine
