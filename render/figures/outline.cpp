#include "render/figures/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace render {
namespace {

constexpr double kSlice = 0.06;  // [m] of a mesh's length
constexpr int kDirections = 96;  // of an ellipsoid's outline: the polygon of a slender one covers 99 % of it

double turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

}  // namespace

std::vector<Point2> convex_hull(std::vector<Point2> p) {
  std::sort(p.begin(), p.end(),
            [](const Point2& a, const Point2& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  p.erase(std::unique(p.begin(), p.end()), p.end());
  if (p.size() < 3) return p;
  std::vector<Point2> hull;
  auto extend = [&hull](const Point2& q, std::size_t least) {
    while (hull.size() >= least + 2 && turn(hull[hull.size() - 2], hull.back(), q) <= 0) hull.pop_back();
    hull.push_back(q);
  };
  for (const Point2& q : p) extend(q, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto q = p.rbegin() + 1; q != p.rend(); ++q) extend(*q, lower);
  hull.pop_back();  // the first point again
  return hull;
}

std::vector<Point2> seen_from_above(const Mesh& mesh, const Pose& X) {
  // the widest points of each slice across the level length, sampled along the edges: mirrors stay small, hollows behind them too;
  // level, as a two-wheeler may lie on its side
  Point2 ahead = (X.q * Vec3::UnitX()).head<2>();
  if (ahead.norm() < 0.1) ahead = (X.q * Vec3::UnitY()).head<2>();  // it stands on end
  ahead.normalize();
  const Point2 left(-ahead.y(), ahead.x());
  std::map<long, std::array<Point2, 2>> slices;
  auto vertex = [&mesh](std::uint32_t i) {
    const float* p = &mesh.positions[3 * static_cast<std::size_t>(i)];
    return Vec3(p[0], p[1], p[2]);
  };
  const auto seen = [&](std::uint32_t i) {  // along and across, from the mesh's origin
    const Point2 p = (X.q * vertex(i)).head<2>();
    return Point2(p.dot(ahead), p.dot(left));
  };
  auto take = [&slices](const Point2& p) {
    const auto [slice, fresh] = slices.try_emplace(std::lround(p.x() / kSlice), std::array<Point2, 2>{p, p});
    auto& [lowest, highest] = slice->second;
    if (p.y() < lowest.y()) lowest = p;
    if (p.y() > highest.y()) highest = p;
  };
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const Point2 a = seen(mesh.indices[i + k]), b = seen(mesh.indices[i + (k + 1) % 3]);
      const int pieces = 1 + static_cast<int>(std::abs(b.x() - a.x()) / (0.5 * kSlice));
      for (int j = 0; j < pieces; ++j) take(a + (b - a) * j / pieces);
    }
  std::vector<Point2> outline;
  const auto placed = [&](const Point2& p) -> Point2 { return X.p.head<2>() + p.x() * ahead + p.y() * left; };
  for (const auto& [number, ends] : slices) outline.push_back(placed(ends[0]));
  for (auto at = slices.rbegin(); at != slices.rend(); ++at) outline.push_back(placed(at->second[1]));
  return outline;
}

std::vector<Point2> seen_from_above(const engine::HyperEllipsoid& shape, const Pose& X) {
  std::vector<Point2> points;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * M_PI * i / kDirections;
    const Vec3 direction = X.q.conjugate() * Vec3(std::cos(angle), std::sin(angle), 0);
    const Vec3 p = X * support_point(shape, direction);
    points.push_back(p.head<2>());
  }
  return points;
}

}  // namespace render
