#include "engine/geometry/mesh_overlap.h"

#include <algorithm>
#include <cmath>
#include <complex>

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

/// A mesh seen along vertical lines.
class Columns {
 public:
  Columns(const TriangleMesh& mesh, const Pose& X_WM)
      : mesh_(mesh), box_(world_bounds(mesh, X_WM)), X_MW_(X_WM.inverse()), up_(X_MW_.q * Vec3::UnitZ()) {}

  /// From the lowest to the highest surface over (x, y); empty where there is none.
  Span at(double x, double y) const {
    if (x < box_.lower.x() || x > box_.upper.x() || y < box_.lower.y() || y > box_.upper.y()) return {};
    const double height = box_.upper.z() - box_.lower.z() + 2e-3;
    const Vec3 foot(x, y, box_.lower.z() - 1e-3);
    double s = 0, t = 0;
    int triangle = -1;
    if (!mesh_.raycast(X_MW_ * foot, up_, height, s, triangle)) return {};
    if (!mesh_.raycast(X_MW_ * Vec3(foot + Vec3(0, 0, height)), -up_, height, t, triangle)) return {};
    return {foot.z() + s, foot.z() + height - t};
  }

 private:
  const TriangleMesh& mesh_;
  Aabb box_;
  Pose X_MW_;
  Vec3 up_;
};

void cast(const Columns& columns, const Grid& grid, std::vector<Span>& spans) {
  for (int i = 0; i < kSide; ++i)
    for (int k = 0; k < kSide; ++k) spans[cell(i, k)] = columns.at(grid.x + (i - 0.5) * grid.dx, grid.y + (k - 0.5) * grid.dy);
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
  const Columns columns_a(a, X_PA), columns_b(b, X_PB);
  reserve(s);
  for (int pass = 0; pass < 2; ++pass) {
    cast(columns_a, grid, s.a);
    cast(columns_b, grid, s.b);
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

bool share_space(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b, const Pose& X_WB, const PlanBox& region) {
  const Columns columns_a(a, seen_from(region.q_WP, X_WA)), columns_b(b, seen_from(region.q_WP, X_WB));
  const Vec3 low = region.box_P.lower, high = region.box_P.upper;
  const Grid grid = over(low.x(), high.x(), low.y(), high.y());
  for (int i = 0; i < kSide; ++i)
    for (int k = 0; k < kSide; ++k) {
      const double x = grid.x + (i - 0.5) * grid.dx, y = grid.y + (k - 0.5) * grid.dy;
      const Span span = columns_a.at(x, y);
      if (span.high > span.low && shared(span, columns_b.at(x, y)) >= kThinnest) return true;
    }
  return false;
}

}  // namespace engine
