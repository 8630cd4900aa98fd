// Which triangles are near, what touches them (mesh_touch.h), and which of the points found stand for all.
#include "engine/geometry/hyper_ellipsoid_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/mesh_touch.h"

namespace engine {
namespace {

constexpr double kLookAhead = 0.15;    // [m] how far beyond the margin a free neighbourhood is told
constexpr double kBoundSlack = 1e-12;  // [-] of bounds beside what they bound
constexpr double kFromBehind = 0.25;   // [-] of the body: deeper than can be by so much is not this side
constexpr double kCluster = 0.985;     // [-] cosine of 10 degrees
constexpr int kKeep = 4;               // contacts of one body with one mesh; one more where a flat side's deepest point counts

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
void let_four_corners_speak(const MeshTouch& s, std::vector<SurfaceContact>& found) {
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
    const double lifted = lowest - deepest.gap;
    if (lifted <= kNoDeeper && corners_carry(s.shape, s.X_MA.q.conjugate() * -deepest.normal))
      for (SurfaceContact& c : found)
        if (c.key > 0 && c.key != kDeepest && on_its_plane(c)) c.lifted = lifted;
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

/// The sphere around the body and the margin.
double sphere_of(const MeshTouch& s) {
  return s.shape.semi_axes.norm() + s.margin;
}

/// Lists the triangles near the body. In the middle of a panel only those count that one of the points lies above that touch_face
/// will look at. What came in may lie `behind` the body by now, of a flat-sided one away from the sides it came through. Where
/// there are none, `apart` has the least distance.
bool list_near_triangles(MeshTouch& s, double behind) {
  constexpr double kSlack = 1e-5;  // [m] for normals that agree to rounding
  const Vec3& centre = s.X_MA.p;
  const Vec3 half = aabb_half_widths(s.shape, s.X_MA.q);
  Aabb box{centre - half, centre + half};
  if (s.flat()) {
    const Aabb body = box;
    for (int side = 0; side < 6; ++side) {
      if (!(s.entered >> side & 1)) continue;
      const Vec3 way = -behind * (s.X_MA.q * outward_of(side));
      box.lower = box.lower.cwiseMin(body.lower + way);
      box.upper = box.upper.cwiseMax(body.upper + way);
    }
    behind = 0;
  }
  bool passed = false;
  auto pass = [&](const Vec3& n, double offset, const Aabb& branch) {
    for (const Vec3& p : s.points_against(n)) {
      const Vec3 at = centre + p, on_plane = at - (n.dot(at) - offset) * n;
      const bool above =
          (on_plane.array() > branch.lower.array() - kSlack).all() && (on_plane.array() < branch.upper.array() + kSlack).all();
      if (above) return false;
    }
    passed = true;
    return true;
  };
  auto look = [&](double around) {
    s.scratch.triangles.clear();
    s.mesh.query({box.lower - Vec3::Constant(around), box.upper + Vec3::Constant(around)}, s.scratch.triangles, pass);
    return passed || !s.scratch.triangles.empty();
  };
  if (look(s.margin + behind)) return true;
  s.scratch.apart = look(s.margin + kLookAhead) ? s.margin : s.margin + kLookAhead;
  return false;
}

/// Away with triangles whose plane the body does not reach, or whose back its centre has passed; marks the others as near.
void keep_reached_triangles(MeshTouch& s, double passed_by) {
  MeshContactScratch& scratch = s.scratch;
  const Mat3 R_AM = s.X_MA.q.conjugate().toRotationMatrix();
  Vec3 last_normal = Vec3::Zero();  // many triangles of a panel share theirs
  double h = 0, least = 0, most = 0;
  bool known = false;
  std::erase_if(scratch.triangles, [&](int t) {
    const Vec3& n = s.mesh.face_normals()[t];
    const double height = n.dot(s.X_MA.p - s.mesh.vertices()[s.mesh.triangles()[t][0]]);
    if (height > sphere_of(s)) return true;
    if (n != last_normal) {
      last_normal = n;
      // the ellipsoid within and a bound without tell most triangles already
      const Vec3 n_A = R_AM * n;
      least = (1 - kBoundSlack) * s.shape.semi_axes.cwiseProduct(n_A).norm();
      most = support_bound(s.shape, n_A);
      known = false;
    }
    if (height - most > s.margin || height < -passed_by * most) return true;
    if (height - least <= s.margin && height >= -passed_by * least) return false;
    if (!known) {
      h = support_value(s.shape, R_AM * n);
      known = true;
    }
    return height - h > s.margin || height < -passed_by * h;
  });
  if (scratch.seen.size() < s.mesh.triangles().size()) scratch.seen.resize(s.mesh.triangles().size());
  if (++scratch.call == 0) {  // after four thousand million calls
    std::fill(scratch.seen.begin(), scratch.seen.end(), MeshContactScratch::Seen{});
    scratch.call = 1;
  }
  std::uint32_t place = 0;
  for (const int t : scratch.triangles) scratch.seen[static_cast<std::size_t>(t)] = {scratch.call, place++};
}

void touch_edges(MeshTouch& s, int triangle) {
  for (int e = 0; e < 3; ++e) {
    if (!(s.flat() ? felt(s.mesh.edge_kind(triangle, e)) : felt_by_round(s.mesh.edge_kind(triangle, e)))) continue;
    const int other = s.mesh.neighbour(triangle, e);
    if (other >= 0 && other < triangle && s.is_near(other)) continue;  // once for both
    if (s.flat()) {
      touch_edge_flat(s, triangle, e);
      for (const int end : {e, (e + 1) % 3}) s.scratch.vertices.push_back(s.mesh.triangles()[triangle][end]);
    } else {
      touch_edge_round(s, triangle, e);
    }
  }
}

void touch_vertices(MeshTouch& s) {
  std::vector<int>& vertices = s.scratch.vertices;
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  for (const int v : vertices) touch_vertex_flat(s, v);
  // more than one edge may lead to a vertex: the first found will do
  std::vector<VertexTouch>& beyond = s.scratch.beyond;
  std::sort(beyond.begin(), beyond.end(), [](const VertexTouch& a, const VertexTouch& b) {
    if (a.vertex != b.vertex) return a.vertex < b.vertex;
    return std::lexicographical_compare(a.normal.data(), a.normal.data() + 3, b.normal.data(), b.normal.data() + 3);
  });
  for (std::size_t i = 0; i < beyond.size(); ++i)
    if (i == 0 || beyond[i].vertex != beyond[i - 1].vertex) touch_vertex_round(s, beyond[i]);
}

/// Of all points those that tell, with their keys, from the mesh's axes to the world's.
void report(MeshTouch& s, const Pose& X_WA, const Quat& q_WM, ContactPoints& out) {
  if (s.flat()) let_four_corners_speak(s, s.scratch.candidates);
  keep_the_telling(s.scratch.candidates, 0.25 * s.shape.semi_axes.minCoeff(), s.flat() ? kKeep + 1 : kKeep, out);
  // in the order of a plane, so that a sheet of triangles is solved as one
  if (s.flat())
    std::sort(out.begin(), out.end(), [](const SurfaceContact& a, const SurfaceContact& b) {
      if (a.key != b.key) return a.key < b.key;
      return std::lexicographical_compare(a.p_b.data(), a.p_b.data() + 3, b.p_b.data(), b.p_b.data() + 3);
    });
  std::uint32_t used = 0;
  for (SurfaceContact& c : out) {
    s.scratch.apart = std::min(s.scratch.apart, c.gap);
    c.key = key_of(c, s.X_MA.q, s.shape.exponent) + 64 * used++;
    c.p_a = X_WA.p + q_WM * c.p_a;
    c.p_b = X_WA.p + q_WM * c.p_b;
    c.normal = q_WM * c.normal;
  }
  // the running number only tells apart what shares a key: give it back where the key is unique
  for (SurfaceContact& c : out) {
    const std::uint32_t plain = c.key % 64;
    if (std::count_if(out.begin(), out.end(), [&](const SurfaceContact& o) { return o.key % 64 == plain; }) == 1) c.key = plain;
  }
}

}  // namespace

Sides sides_of(const HyperEllipsoid& shape, const Quat& q_WA, const ContactPoints& contacts) {
  constexpr double kSquare = 0.9;  // [-] cosine to the side's normal
  if (shape.exponent < kFlatExponent) return 0;
  unsigned out = 0;
  for (const SurfaceContact& c : contacts) {
    const Vec3 outward_A = q_WA.conjugate() * -c.normal;
    int axis = 0;
    if (c.gap < 0 && outward_A.cwiseAbs().maxCoeff(&axis) > kSquare) out |= 1u << (2 * axis + (outward_A[axis] > 0));
  }
  return static_cast<Sides>(out);
}

void reserve(MeshContactScratch& scratch, const TriangleMesh& mesh) {
  const std::size_t count = mesh.triangles().size();
  scratch.triangles.reserve(count);
  if (scratch.seen.size() < count) scratch.seen.resize(count);
  scratch.points.reserve(count);
  scratch.vertices.reserve(6 * count);
  scratch.beyond.reserve(std::min<std::size_t>(3 * count, 4096));
  scratch.candidates.reserve(std::min<std::size_t>(4 * count, 4096));
}

void contacts_with_mesh(const HyperEllipsoid& shape, const Pose& X_WA, const TriangleMesh& mesh, const Pose& X_WM, double margin,
                        double least, MeshContactScratch& scratch, ContactPoints& out, double passed_by, Sides entered) {
  out.clear();
  const Pose X_MA = X_WM.inverse() * X_WA;
  MeshTouch s{shape, X_MA, mesh, margin, least - kFromBehind * shape.semi_axes.minCoeff(), entered, scratch};
  // the sphere around the body first: most pairs are far apart
  scratch.apart = (X_MA.p - mesh.bounds().upper).cwiseMax(mesh.bounds().lower - X_MA.p).maxCoeff() - sphere_of(s) + margin;
  if (scratch.apart > margin) return;
  scratch.apart = 0;
  if (!list_near_triangles(s, std::isfinite(passed_by) ? 0 : std::max(0.0, -s.least))) return;
  keep_reached_triangles(s, passed_by);
  scratch.candidates.clear();
  scratch.vertices.clear();
  scratch.beyond.clear();
  scratch.points.clear();
  for (const int t : scratch.triangles) touch_face(s, t);
  for (const int t : scratch.triangles) touch_edges(s, t);
  touch_vertices(s);
  report(s, X_WA, X_WM.q, out);
}

}  // namespace engine
