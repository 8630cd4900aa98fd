#include "engine/geometry/mesh_overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

#include "engine/math/functions.h"

namespace engine {
namespace {

constexpr int kCells = 64;          // along each side
constexpr int kSide = kCells + 2;   // with one cell of margin, so that the grid can be shifted by one
constexpr double kThinnest = 1e-6;  // [m] overlap along a line that counts
constexpr double kApart = 1e-6;     // [-] headings 45 degrees apart have no mean by quarter turns

using Span = OverlapScratch::Span;

struct Grid {
  double x = 0, y = 0, dx = 0, dy = 0;  // first cell's corner and sizes, margin left out
};

std::size_t cell(int i, int k) {
  return static_cast<std::size_t>(i * kSide + k);
}

double shared(const Span& p, const Span& q, double lift = 0) {
  return std::max(0.0, std::min(p.high + lift, q.high) - std::max(p.low + lift, q.low));
}

/// z of a triangle over (x, y) of the plane; nothing beside it, and none of one that stands upright.
std::optional<double> height_over(const std::array<Vec3, 3>& corners, double x, double y) {
  constexpr double kOnEdge = -1e-12;  // [-] a line along an edge meets both triangles
  const Vec3 &o = corners[0], u = corners[1] - o, v = corners[2] - o;
  const double area = u.x() * v.y() - u.y() * v.x();
  if (area == 0) return std::nullopt;
  const double s = ((x - o.x()) * v.y() - (y - o.y()) * v.x()) / area, t = (u.x() * (y - o.y()) - u.y() * (x - o.x())) / area;
  if (s < kOnEdge || t < kOnEdge || s + t > 1 - kOnEdge) return std::nullopt;
  return o.z() + s * u.z() + t * v.z();
}

/// Cells [first, last] whose lines lie between two coordinates.
std::pair<int, int> cells_between(double low, double high, double begin, double size) {
  return {std::max(0, static_cast<int>(std::ceil((low - begin) / size + 0.5 - 1e-9))),
          std::min(kSide - 1, static_cast<int>(std::floor((high - begin) / size + 0.5 + 1e-9)))};
}

/// From the lowest to the highest surface along each vertical line of the grid; empty where there is none.
void cast(const TriangleMesh& mesh, const Pose& X_PM, const Grid& grid, std::vector<Span>& spans) {
  std::fill(spans.begin(), spans.end(), Span{});
  for (const Triangle& triangle : mesh.triangles()) {
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = X_PM * mesh.vertices()[static_cast<std::size_t>(triangle[i])];
    const auto [x_low, x_high] = std::minmax({corners[0].x(), corners[1].x(), corners[2].x()});
    const auto [y_low, y_high] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
    const auto columns = cells_between(x_low, x_high, grid.x, grid.dx), rows = cells_between(y_low, y_high, grid.y, grid.dy);
    for (int i = columns.first; i <= columns.second; ++i)
      for (int k = rows.first; k <= rows.second; ++k) {
        const auto z = height_over(corners, grid.x + (i - 0.5) * grid.dx, grid.y + (k - 0.5) * grid.dy);
        Span& span = spans[cell(i, k)];
        if (z) span = span.high < span.low ? Span{*z, *z} : Span{std::min(span.low, *z), std::max(span.high, *z)};
      }
  }
}

/// Shared volume with a's columns shifted by whole cells, or lifted.
double volume(const OverlapScratch& s, const Grid& grid, int di, int dk) {
  double sum = 0;
  for (int i = std::max(0, di); i < kSide + std::min(0, di); ++i)
    for (int k = std::max(0, dk); k < kSide + std::min(0, dk); ++k) sum += shared(s.a[cell(i - di, k - dk)], s.b[cell(i, k)]);
  return sum * grid.dx * grid.dy;
}

Grid over(double x_low, double x_high, double y_low, double y_high) {
  return {x_low, y_low, (x_high - x_low) / kCells, (y_high - y_low) / kCells};
}

/// Smallest grid around the cells that share something; false if there are none.
bool tighten(const OverlapScratch& s, Grid& grid) {
  int i_low = kSide, i_high = -1, k_low = kSide, k_high = -1;
  for (int i = 0; i < kSide; ++i)
    for (int k = 0; k < kSide; ++k) {
      if (shared(s.a[cell(i, k)], s.b[cell(i, k)]) < kThinnest) continue;
      i_low = std::min(i_low, i), i_high = std::max(i_high, i);
      k_low = std::min(k_low, k), k_high = std::max(k_high, k);
    }
  if (i_high < 0) return false;
  // a cell stands for half a cell on either side of its line that was not looked at: one cell more all round
  grid = over(grid.x + (i_low - 2) * grid.dx, grid.x + (i_high + 1) * grid.dx, grid.y + (k_low - 2) * grid.dy,
              grid.y + (k_high + 1) * grid.dy);
  return true;
}

/// Heading of a body as a unit number to the fourth power, in which quarter turns are the same; 0 of one that stands on end.
std::complex<double> quarter_turns(const Quat& q_WB) {
  const Vec3 forward = q_WB * Vec3::UnitX();
  const double length = math::hypot(forward.x(), forward.y());
  if (length < kApart) return 0;
  const std::complex<double> heading(forward.x() / length, forward.y() / length);
  return heading * heading * heading * heading;
}

/// Plan axes along the two, or half-way between where they stand askew to each other.
Quat plan_axes(const Quat& q_WA, const Quat& q_WB) {
  const std::complex<double> a = quarter_turns(q_WA), both = a + quarter_turns(q_WB);
  const std::complex<double> mean = std::norm(both) > kApart ? both : a;
  return math::rotation(0.25 * math::atan2(mean.imag(), mean.real()), Vec3::UnitZ());
}

Pose seen_from(const Quat& q_WP, const Pose& X_WB) {
  return Pose{Vec3::Zero(), q_WP.conjugate()} * X_WB;
}

}  // namespace

void reserve(OverlapScratch& scratch) {
  for (auto* spans : {&scratch.a, &scratch.b}) spans->resize(static_cast<std::size_t>(kSide) * kSide);
}

Aabb world_bounds(const TriangleMesh& mesh, const Pose& X_WM) {
  const Vec3 centre = X_WM * Vec3(0.5 * (mesh.bounds().lower + mesh.bounds().upper));
  const Vec3 half = X_WM.q.toRotationMatrix().cwiseAbs() * (0.5 * (mesh.bounds().upper - mesh.bounds().lower));
  return {centre - half, centre + half};
}

std::optional<MeshOverlap> overlap_of(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b, const Pose& X_WB,
                                      OverlapScratch& s) {
  const Quat q_WP = plan_axes(X_WA.q, X_WB.q);
  const Pose X_PA = seen_from(q_WP, X_WA), X_PB = seen_from(q_WP, X_WB);
  const Aabb box_a = world_bounds(a, X_PA), box_b = world_bounds(b, X_PB);
  const Vec3 low = box_a.lower.cwiseMax(box_b.lower), high = box_a.upper.cwiseMin(box_b.upper);
  if ((low.array() >= high.array()).any()) return std::nullopt;
  Grid grid = over(low.x(), high.x(), low.y(), high.y());
  reserve(s);
  for (int pass = 0; pass < 2; ++pass) {
    cast(a, X_PA, grid, s.a);
    cast(b, X_PB, grid, s.b);
    if (pass == 0 && !tighten(s, grid)) return std::nullopt;
  }
  MeshOverlap out;
  Vec3 moment = Vec3::Zero();
  for (int i = 0; i < kSide; ++i)
    for (int k = 0; k < kSide; ++k) {
      const Span& p = s.a[cell(i, k)];
      const Span& q = s.b[cell(i, k)];
      const double part = shared(p, q) * grid.dx * grid.dy;
      const double z = 0.5 * (std::min(p.high, q.high) + std::max(p.low, q.low));
      if (part > 0) moment += part * Vec3(grid.x + (i - 0.5) * grid.dx, grid.y + (k - 0.5) * grid.dy, z);
      out.volume += part;
    }
  if (out.volume <= 0) return std::nullopt;
  out.centroid = q_WP * Vec3(moment / out.volume);
  out.region.q_WP = q_WP;
  out.region.box_P.lower = Vec3(grid.x, grid.y, low.z());
  out.region.box_P.upper = Vec3(grid.x + kCells * grid.dx, grid.y + kCells * grid.dy, high.z());
  const Vec3 growth((volume(s, grid, 1, 0) - volume(s, grid, -1, 0)) / (2 * grid.dx),
                    (volume(s, grid, 0, 1) - volume(s, grid, 0, -1)) / (2 * grid.dy), 0);
  // one body wholly inside the other in plan: no side to speak of, the line of centres is what is left
  const Vec3 apart = Vec3(0.5 * (box_a.lower + box_a.upper - box_b.lower - box_b.upper)).cwiseProduct(Vec3(1, 1, 0));
  const Vec3 normal_P = growth.norm() > 1e-9 ? Vec3(-growth.normalized()) : (apart.norm() > 0 ? apart.normalized() : Vec3::UnitX());
  out.normal_W = q_WP * normal_P;
  return out;
}

bool share_space(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b, const Pose& X_WB, const PlanBox& region,
                 OverlapScratch& s) {
  const Vec3 low = region.box_P.lower, high = region.box_P.upper;
  const Grid grid = over(low.x(), high.x(), low.y(), high.y());
  reserve(s);
  cast(a, seen_from(region.q_WP, X_WA), grid, s.a);
  cast(b, seen_from(region.q_WP, X_WB), grid, s.b);
  for (std::size_t i = 0; i < s.a.size(); ++i)
    if (s.a[i].high > s.a[i].low && shared(s.a[i], s.b[i]) >= kThinnest) return true;
  return false;
}

}  // namespace engine
