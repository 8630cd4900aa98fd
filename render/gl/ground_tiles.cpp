#include "render/gl/ground_tiles.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

namespace render::gl {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;

constexpr int kTile = 16;  // [pixels at 720 lines]

Vector3d three(const float* v) {
  return {v[0], v[1], v[2]};
}

struct Field {  // a tile's ground
  Array2d lower, upper;
};

/// Where the ray of a corner of the tile grid meets the ground; nothing at or above the horizon.
std::optional<Array2d> meet(const shade::FrameData& b, double x, double y) {
  const Vector3d a = three(b.near_0) + x * three(b.near_x) + y * three(b.near_y);
  const Vector3d d = three(b.far_0) + x * three(b.far_x) + y * three(b.far_y) - a;
  const double s = d.z() < -1e-6 ? (b.ground[0] - a.z()) / d.z() : -1;
  if (s < 0 || s > 1e4) return std::nullopt;
  return Array2d(a.x() + s * d.x(), a.y() + s * d.y());
}

Zone zone_of(const Field& f, const RoadLook& road) {
  if (!road.road || road.metre_grid || road.picture) return Zone::everything;
  // filters reach over the tile by part of its own size
  const double reach = 0.5 * (f.upper - f.lower).maxCoeff() + 0.05;
  const double low = f.lower[1] - reach - road.centre_y, high = f.upper[1] + reach - road.centre_y;
  const double half = road.width / 2, farthest = std::max(std::abs(low), std::abs(high));
  const double nearest = low > 0 ? low : high < 0 ? -high : 0;
  if (nearest > half + 2.4) return Zone::grass;  // the pavement ends at 2.15 m, raggedly
  if (nearest > half + 0.25 && farthest < half + 2.0) return Zone::pavement;
  if (farthest > half) return Zone::everything;
  if (road.zebra || farthest > half - 0.35) return Zone::roadway;
  const double lane = road.width / std::max(road.lanes, 1);
  for (int i = 1; i < road.lanes; ++i) {
    const double line = -half + lane * i;
    if (low < line + 0.1 && high > line - 0.1) return Zone::roadway;
  }
  return Zone::asphalt;
}

Sun sun_of(const Field& f, const FrameSetup& frame, const DepthPyramid& depth) {
  if (!frame.casts) return Sun::bare;
  const shade::FrameData& b = frame.data;
  Eigen::Array3d lower = Eigen::Array3d::Constant(1e9), upper = Eigen::Array3d::Constant(-1e9);
  const double lift = 1.5 * static_cast<double>(std::max(b.shadow[0], b.shadow[1]));  // as in shade/shadow.h
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector4d p(k & 1 ? f.upper[0] : f.lower[0], k & 2 ? f.upper[1] : f.lower[1],
                            static_cast<double>(b.ground[0]) + lift, 1);
    const Eigen::Array3d q = (frame.world_to_shadow_clip * p).head<3>().array() * 0.5 + 0.5;
    lower = lower.min(q);
    upper = upper.max(q);
  }
  constexpr double kRound = 2e-5;  // [-] of single precision in the kernel, in map and depth
  const DepthPyramid::Range range = depth.over(lower[0] - kRound, lower[1] - kRound, upper[0] + kRound, upper[1] + kRound);
  const auto end = [](double z) { return std::min(z, 1.0); };
  const bool lit = range.least >= 1 || end(upper[2]) + kRound < static_cast<double>(range.least);
  const bool dark = end(lower[2]) - kRound > static_cast<double>(range.largest);
  if (!lit) return dark ? Sun::dark : Sun::open;
  const bool occluded = f.upper[0] > static_cast<double>(b.occlusion[0]) && f.upper[1] > static_cast<double>(b.occlusion[1]) &&
                        f.lower[0] < static_cast<double>(b.occlusion[0] + b.occlusion[2]) &&
                        f.lower[1] < static_cast<double>(b.occlusion[1] + b.occlusion[3]);
  return occluded ? Sun::lit : Sun::bare;
}

/// Equal neighbours become one rectangle: along rows, then rows that are alike.
class Mosaic {
 public:
  void row(int y, int height, const std::vector<std::pair<int, TileLook>>& ends) {
    std::vector<std::pair<TileLook, Rectangle>> runs;
    int x = 0;
    for (const auto& [end, look] : ends) {
      if (!runs.empty() && runs.back().first == look)
        runs.back().second.width += end - x;
      else
        runs.push_back({look, {x, y, end - x, height}});
      x = end;
    }
    for (auto& [look, r] : runs) {
      const auto same = std::find_if(open_.begin(), open_.end(), [&, l = look, rect = r](const auto& o) {
        return o.first == l && o.second.x == rect.x && o.second.width == rect.width;
      });
      if (same == open_.end()) continue;
      r = {r.x, same->second.y, r.width, same->second.height + height};
      open_.erase(same);
    }
    close();
    open_ = std::move(runs);
  }
  TileMap finish() {
    close();
    return std::move(map_);
  }

 private:
  void close() {
    for (const auto& [look, r] : open_) map_[look].push_back(r);
    open_.clear();
  }
  std::vector<std::pair<TileLook, Rectangle>> open_;
  TileMap map_;
};

}  // namespace

TileMap lay_tiles(const FrameSetup& frame, const RoadLook& road, const DepthPyramid& depth, Shade shade, int width, int height) {
  const int tile = kTile * std::max(1, height / 720);
  // rows of near ground, of ground, of sky
  std::vector<int> bounds;
  for (int y = 0; y < height; y += tile) bounds.push_back(y);
  bounds.insert(bounds.end(), {frame.near_to, frame.sky_from, height});
  std::sort(bounds.begin(), bounds.end());
  bounds.erase(std::unique(bounds.begin(), bounds.end()), bounds.end());
  const auto corners = [&](int y) {
    std::vector<std::optional<Array2d>> out;
    if (y <= frame.sky_from)
      for (int x = 0; x < width + tile; x += tile) out.push_back(meet(frame.data, std::min(x, width), y));
    return out;
  };
  Mosaic mosaic;
  std::vector<std::optional<Array2d>> low = corners(bounds.front()), high;
  std::vector<std::pair<int, TileLook>> ends;
  for (std::size_t row = 0; row + 1 < bounds.size(); ++row, low = std::move(high)) {
    const int from = bounds[row], to = bounds[row + 1];
    high = corners(to);
    ends.clear();
    if (from >= frame.sky_from) {
      mosaic.row(from, to - from, {{width, {}}});
      continue;
    }
    for (std::size_t i = 0; i + 1 < low.size(); ++i) {
      const bool shaded = shade == Shade::cast;
      TileLook look{Zone::everything, shaded && frame.casts ? Sun::open : Sun::bare, to <= frame.near_to};
      if (low[i] && low[i + 1] && high[i] && high[i + 1]) {
        const Field field{low[i]->min(*low[i + 1]).min(*high[i]).min(*high[i + 1]),
                          low[i]->max(*low[i + 1]).max(*high[i]).max(*high[i + 1])};
        look.zone = zone_of(field, road);
        if (shaded) look.sun = sun_of(field, frame, depth);
      } else if (to <= frame.shade.y || from >= frame.shade.y + frame.shade.height) {
        look.sun = Sun::bare;
      }
      ends.emplace_back(std::min(width, static_cast<int>(i + 1) * tile), look);
    }
    mosaic.row(from, to - from, ends);
  }
  return mosaic.finish();
}

}  // namespace render::gl
