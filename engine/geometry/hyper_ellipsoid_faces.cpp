// As of two boxes: the axis of a side along which the two overlap least separates them (S. Gottschalk, M. Lin, D. Manocha, OBBTree,
// SIGGRAPH 1996); the other's side that faces it is clipped against it (I. Sutherland, G. Hodgman, CACM 17 (1974)). A side is the
// quadrilateral of its corner points, and the gap at a corner of the clipped one that between the true surfaces along the normal.
#include "engine/geometry/hyper_ellipsoid_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/geometry/face_corners.h"
#include "engine/math/functions.h"

namespace engine {
namespace {

constexpr double kLeastFacing = 0.98;  // [-] cosine between two sides: beyond 11 degrees an edge touches
constexpr double kNoBetter = 1e-5;     // [m] by which the second body's side must separate better to be taken: no taking turns
constexpr double kDepthCounts = 10;    // [-] a centimetre of depth counts like a decimetre of distance
constexpr double kParallel = 1e-3;     // [rad] edges that cross at less have their corners to stand for them
constexpr double kRounding = 1e-14;    // [-] of the half thickness
constexpr double kSamePoint = 0.02;    // [-] of the smaller side: corners that are nearer to each other are one

/// A body, and one of its sides: the axis that points out of it.
struct Side {
  const HyperEllipsoid& shape;
  const Pose& X;
  Mat3 R;
  int axis = 0;
  double sign = 1;

  Vec3 out() const { return sign * R.col(axis); }
  void face(const Vec3& direction) {
    (R.transpose() * direction).cwiseAbs().maxCoeff(&axis);
    sign = R.col(axis).dot(direction) < 0 ? -1 : 1;
  }
};

using Plane = Eigen::Vector2d;
using Quad = std::array<Plane, 4>;

/// The corners of a side, in turn about it.
struct SideCorners {
  Quad at;                         // along the normal, as a View sees them
  std::array<double, 4> heights;   // [m] along the normal
  std::array<Vec3, 4> directions;  // body axes, unit: of the tangent planes there
  double reach = 0;                // [m] how far from the centre all four planes stand: mirror images
};

double cross(const Plane& a, const Plane& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Does a side lie over or under a point, short of its rim?
bool covers(const Side& side, const Vec3& p) {
  constexpr double kRim = 0.97;  // [-] of the half widths
  const Vec3 x = (side.R.transpose() * (p - side.X.p)).cwiseQuotient(side.shape.semi_axes).cwiseAbs();
  return x[(side.axis + 1) % 3] < kRim && x[(side.axis + 2) % 3] < kRim;
}

/// A point of the patch, seen along the normal.
struct Corner {
  Plane at;
  std::uint32_t key = 0;
};
using Corners = SmallVector<Corner, 24>;
using Points = SmallVector<SurfaceContact, 24>;

/// Two sides as they are seen along the normal.
struct View {
  Vec3 origin, t1, t2, normal;

  Plane of(const Vec3& p) const { return {t1.dot(p - origin), t2.dot(p - origin)}; }
  double height(const Vec3& p) const { return normal.dot(p - origin); }
  Vec3 at(const Plane& p) const { return origin + p.x() * t1 + p.y() * t2; }
};

/// The corners of a side. The more two sides lean to each other, the nearer to the rim they touch. They are mirror images: one
/// search serves all.
SideCorners corners_of(const Side& side, double lean, const View& view) {
  SideCorners out;
  out.directions = corner_directions(side.shape, side.sign * Vec3::Unit(side.axis), lean);
  std::swap(out.directions[2], out.directions[3]);  // they come row by row
  const Support one = support(side.shape, out.directions[0]);
  out.reach = one.value;
  for (std::size_t i = 0; i < 4; ++i) {
    Vec3 corner_B;
    for (int k = 0; k < 3; ++k) corner_B[k] = std::copysign(one.point[k], out.directions[i][k]);
    const Vec3 corner = side.X * corner_B;
    out.heights[i] = view.height(corner);
    out.at[i] = view.of(corner);
  }
  return out;
}

/// How far [m] a point lies inside a quad, negative outside.
double inside(const Quad& quad, const Plane& p) {
  const double sense = cross(quad[2] - quad[0], quad[3] - quad[1]) < 0 ? -1 : 1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    const Plane edge = quad[(i + 1) % 4] - quad[i];
    const double length = edge.norm();
    if (length > 0) least = std::min(least, sense * cross(edge, p - quad[i]) / length);
  }
  return least;
}

/// Collects corners; what nearly coincides is one.
struct Clip {
  const Quad &a, &b;
  double same;  // [m]
  Corners& out;

  void add(const Plane& p, std::uint32_t key) {
    const bool known = std::any_of(out.begin(), out.end(), [&](const Corner& c) { return (c.at - p).norm() < same; });
    if (!known) out.push_back({p, key});
  }
  /// Corners of either that lie in the other, as two predicates say.
  template <class InA, class InB>
  void corners(InA&& in_a, InB&& in_b) {
    for (std::uint32_t i = 0; i < 4; ++i)
      if (in_b(a[i])) add(a[i], 1 + i);
    for (std::uint32_t i = 0; i < 4; ++i)
      if (in_a(b[i])) add(b[i], 5 + i);
  }
  void crossings() {
    for (std::uint32_t i = 0; i < 4; ++i)
      for (std::uint32_t k = 0; k < 4; ++k) {
        const Plane u = a[(i + 1) % 4] - a[i], v = b[(k + 1) % 4] - b[k], d = b[k] - a[i];
        const double turn = cross(u, v);
        if (std::abs(turn) <= kParallel * u.norm() * v.norm()) continue;
        const double s = cross(d, v) / turn, r = cross(d, u) / turn;
        if (s >= 0 && s <= 1 && r >= 0 && r <= 1) add(a[i] + s * u, 9 + 4 * i + k);
      }
  }
};

/// Corners of what two sides share. Leaning, a side touches beyond the flat of the other, near its rim.
void clip(const View& view, const Side& side_a, const Quad& a, const Side& side_b, const Quad& b, Corners& out) {
  double size = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 2; ++i) size = std::min({size, (a[i + 2] - a[i]).norm(), (b[i + 2] - b[i]).norm()});
  Clip clip{a, b, kSamePoint * size, out};
  const double rounding = 0.5 * clip.same;
  clip.corners([&](const Plane& p) { return inside(a, p) > -rounding; }, [&](const Plane& p) { return inside(b, p) > -rounding; });
  clip.crossings();
  if (out.empty())
    clip.corners([&](const Plane& p) { return covers(side_a, view.at(p)); },
                 [&](const Plane& p) { return covers(side_b, view.at(p)); });
}

/// A body lies behind the plane of its side and behind those through the side's corners: how far along `n` from `x` (body axes) the
/// nearest is.
double nearest_plane(const Side& side, const SideCorners& corners, const Vec3& x, const Vec3& n) {
  double nearest = (side.shape.semi_axes[side.axis] - side.sign * x[side.axis]) / (side.sign * n[side.axis]);
  for (const Vec3& direction : corners.directions)
    if (const double slope = direction.dot(n); slope > 0) nearest = std::min(nearest, (corners.reach - direction.dot(x)) / slope);
  return nearest;
}

/// How far along `n` [m] from `p` the surface lies on the side of a body that faces n. Newton from outside: the gauge is convex
/// along the line, so it comes down on the root from beyond. A step s leaves about (n-1) s^2 / (2 a): one that leaves less than
/// rounding is the last. Not a number where the line misses the body.
double surface_along(const Side& side, const SideCorners& corners, const Vec3& p, const Vec3& n) {
  const Vec3 x_B = side.R.transpose() * (p - side.X.p), n_B = side.R.transpose() * n;
  const double thinnest = side.shape.semi_axes.minCoeff(), bend = 0.5 * (side.shape.exponent - 1) / thinnest;
  double t = nearest_plane(side, corners, x_B, n_B);
  for (int k = 0; k < 20; ++k) {
    const GaugeAt at = gauge_at(side.shape, x_B + t * n_B);
    const double slope = at.gradient.dot(n_B);
    if (!(slope > 0)) return std::numeric_limits<double>::quiet_NaN();
    const double step = (at.value - 1) / slope;
    t -= step;
    if (bend * step * step < kRounding * thinnest) break;
  }
  return t;
}

/// Two sides that face each other, as they are seen along the normal.
struct Facing {
  const Side &a, &b;
  const SideCorners &of_a, &of_b;
  const View& view;
};

/// What lies over a corner of the patch: both surfaces, along the normal. A corner of a side is a point of its surface. Infinitely
/// far where one of them is not there.
SurfaceContact between(const Facing& f, const Corner& corner) {
  const std::uint32_t i = corner.key - 1;  // as Clip counts: the corners of a, those of b, crossings
  const Vec3 p = f.view.at(corner.at), &normal = f.view.normal;
  const double to_a = i < 4 ? -f.of_a.heights[i] : surface_along(f.a, f.of_a, p, -normal);
  const double to_b = i >= 4 && i < 8 ? f.of_b.heights[i - 4] : surface_along(f.b, f.of_b, p, normal);
  SurfaceContact c;
  c.normal = normal;
  c.p_a = p - to_a * normal;
  c.p_b = p + to_b * normal;
  c.gap = std::isfinite(to_a + to_b) ? -to_a - to_b : std::numeric_limits<double>::infinity();
  c.key = corner.key;
  return c;
}

/// The two along an axis that separates them, as far as can be said without powers: along its own axis a body reaches as far as
/// that semi-axis, along any other at least as far as its share of the longest and at most as far as those of all three.
struct AlongAxis {
  Vec3 normal, normal_other;   // from b to a; in the axes of the body whose axis it is not
  double beyond_own = 0;       // [m] from the side to the other's centre
  double least = 0, most = 0;  // [m] the distance

  AlongAxis(const Side& own, const Side& other, int axis, const Vec3& d) {
    normal = own.R.col(axis);
    if (normal.dot(d) < 0) normal = -normal;
    normal_other = other.R.transpose() * normal;
    beyond_own = normal.dot(d) - own.shape.semi_axes[axis];
    const Vec3 shares = other.shape.semi_axes.cwiseProduct(normal_other.cwiseAbs());
    least = beyond_own - shares.sum();
    most = beyond_own - shares.maxCoeff();
  }
};

/// The largest distance [m] of the two along an axis of either, negative where they overlap along all, and that axis, from b to a.
double separate_along_axes(const Side& a, const Side& b, Vec3& normal) {
  const Vec3 d = a.X.p - b.X.p;
  double gap = -std::numeric_limits<double>::infinity();
  for (const bool of_a : {true, false}) {
    const Side &own = of_a ? a : b, &other = of_a ? b : a;
    const std::array<AlongAxis, 3> axes{AlongAxis{own, other, 0, d}, AlongAxis{own, other, 1, d}, AlongAxis{own, other, 2, d}};
    const double sure = std::max({axes[0].least, axes[1].least, axes[2].least});  // one of the three is as much
    for (const AlongAxis& axis : axes) {
      const double better = gap + (of_a ? 0 : kNoBetter);
      if (axis.most < sure || axis.most <= better) continue;
      const double along = axis.beyond_own - support_value(other.shape, axis.normal_other);
      if (along > better) gap = along, normal = axis.normal;
    }
  }
  return gap;
}

/// Of many points the deepest and three far from those kept before.
void keep_four(Points& points) {
  if (points.size() <= 4) return;
  for (int kept = 0; kept < 4; ++kept) {
    int next = kept;
    double best = -std::numeric_limits<double>::infinity();
    for (int i = kept; i < points.size(); ++i) {
      double merit = kept == 0 ? 0 : std::numeric_limits<double>::infinity();
      for (int j = 0; j < kept; ++j) merit = std::min(merit, (points[i].p_a - points[j].p_a).norm());
      merit -= kDepthCounts * points[i].gap;
      if (merit > best) best = merit, next = i;
    }
    std::swap(points[kept], points[next]);
  }
  points.resize_down(4);
}

}  // namespace

FacesMeet contacts_of_faces(const HyperEllipsoid& A, const Pose& X_WA, const HyperEllipsoid& B, const Pose& X_WB, double margin,
                            ContactPoints& out, double& apart) {
  out.clear();
  if (A.exponent < kFlatSides || B.exponent < kFlatSides) return FacesMeet::other;
  Side a{A, X_WA, X_WA.q.toRotationMatrix()}, b{B, X_WB, X_WB.q.toRotationMatrix()};
  Vec3 normal;
  apart = separate_along_axes(a, b, normal);
  if (apart >= margin) return FacesMeet::apart;
  a.face(-normal);
  b.face(normal);
  if (-a.out().dot(b.out()) < kLeastFacing) return FacesMeet::other;

  const Vec3 t1 = normal.unitOrthogonal();
  const View view{X_WB.p, t1, normal.cross(t1), normal};
  Corners corners;
  const double lean = std::max(kCornerLean, a.out().cross(b.out()).norm());
  const SideCorners of_a = corners_of(a, lean, view), of_b = corners_of(b, lean, view);
  clip(view, a, of_a.at, b, of_b.at, corners);
  Points points;
  for (const Corner& corner : corners) {
    const SurfaceContact c = between({a, b, of_a, of_b, view}, corner);
    if (c.gap < margin) points.push_back(c);
  }
  keep_four(points);
  for (const SurfaceContact& c : points) out.push_back(c);
  return out.empty() ? FacesMeet::other : FacesMeet::flat;
}

}  // namespace engine
