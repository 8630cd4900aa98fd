// Polygons cut to what a grid of samples can take. A corner has its place `clip` in clip space and what else is linear over the
// polygon in `rest`.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace render::gl {

constexpr double kSub = 64, kFarthest = 31000;  // of render/shade/raster.h; [samples] within what it draws

template <int kRest>
struct CutPoint {
  Eigen::Vector4d clip;
  Eigen::Matrix<double, kRest, 1> rest;
};
template <int kRest>
using CutPolygon = std::vector<CutPoint<kRest>>;

/// The part of a polygon where `inside` is not negative; linear over it.
template <int kRest, class Inside>
CutPolygon<kRest> cut_by(const CutPolygon<kRest>& polygon, Inside inside) {
  CutPolygon<kRest> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const CutPoint<kRest>&a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = inside(a.clip), at_b = inside(b.clip);
    if (at_a >= 0) out.push_back(a);
    if ((at_a >= 0) == (at_b >= 0)) continue;
    const double s = at_a / (at_a - at_b);
    out.push_back({a.clip + s * (b.clip - a.clip), a.rest + s * (b.rest - a.rest)});
  }
  return out;
}

/// Beyond the near plane, a little before the eye at the least, and not farther aside than a grid of so many samples reaches.
template <int kRest>
CutPolygon<kRest> cut_to_grid(CutPolygon<kRest> polygon, double width, double height) {
  using Eigen::Vector4d;
  const double wide = kFarthest / (width / 2) - 1, high = kFarthest / (height / 2) - 1;
  polygon = cut_by(polygon, [](const Vector4d& c) { return c[2] + c[3]; });
  polygon = cut_by(polygon, [](const Vector4d& c) { return c[3] - 1e-5; });
  polygon = cut_by(polygon, [wide](const Vector4d& c) { return wide * c[3] - c[0]; });
  polygon = cut_by(polygon, [wide](const Vector4d& c) { return wide * c[3] + c[0]; });
  polygon = cut_by(polygon, [high](const Vector4d& c) { return high * c[3] - c[1]; });
  return cut_by(polygon, [high](const Vector4d& c) { return high * c[3] + c[1]; });
}

/// [1/64 sample] of a place -1..1 on a side of so many samples.
inline std::int32_t sub_sample(double ndc, double size) {
  return static_cast<std::int32_t>(std::lround(std::clamp((ndc + 1) / 2 * size, -kFarthest, kFarthest) * kSub));
}

}  // namespace render::gl
