// Where marks and traces lie: on the ground under them, be it the plane or a terrain.
#pragma once

#include <cmath>

#include "engine/geometry/triangle_mesh.h"
#include "render/draw_list.h"
#include "render/matrix.h"
#include "render/stage.h"

namespace render {

constexpr double kMarkingSlip = 0.3;  // [m/s] below it a tyre leaves no mark

struct Spot {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
};

/// The terrain straight under or over a point near it; the point itself where there is none within a metre.
inline Spot on_ground(const RoadLook& road, const Vec3& p) {
  constexpr double kReach = 1.0;  // [m]
  if (!road.terrain_surface) return {p, Vec3::UnitZ()};
  const Vec3 above = p + kReach * Vec3::UnitZ();
  double s = 0;
  int triangle = -1;
  if (!road.terrain_surface->raycast(above, -Vec3::UnitZ(), 2 * kReach, s, triangle)) return {p, Vec3::UnitZ()};
  const Vec3& normal = road.terrain_surface->face_normals()[static_cast<std::size_t>(triangle)];
  return {above - s * Vec3::UnitZ(), normal.z() < 0 ? Vec3(-normal) : normal};
}

/// The next point of a line that lies on the ground; on a terrain with those between it and the last.
inline void lay_on_ground(const RoadLook& road, const Vec3& p, double lift, LineItem& line) {
  constexpr double kLongest = 0.1;  // [m] between points on a terrain
  if (!road.terrain_surface) {
    line.points.push_back(to_float(p + lift * Vec3::UnitZ()));
    return;
  }
  const auto lay = [&](const Vec3& at) {
    const Spot spot = on_ground(road, at);
    line.points.push_back(to_float(spot.point + lift * spot.normal));
    line.normals.push_back(to_float(spot.normal));
  };
  if (!line.points.empty()) {
    const Vec3 last(line.points.back()[0], line.points.back()[1], line.points.back()[2]);
    const double way = (p - last).norm();
    const int pieces = way < 20 * kLongest ? static_cast<int>(std::ceil(way / kLongest)) : 1;
    for (int i = 1; i < pieces; ++i) lay(last + (p - last) * i / pieces);
  }
  lay(p);
}

}  // namespace render
