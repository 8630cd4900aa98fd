// Outlines in a plane: what a body covers seen from above or from the side.
#pragma once

#include <vector>

#include "engine/geometry/hyper_ellipsoid.h"
#include "render/stage.h"

namespace render {

using Point2 = Eigen::Vector2d;

/// Counter-clockwise convex hull (monotone chain, Andrew 1979), without its collinear points.
std::vector<Point2> convex_hull(std::vector<Point2> points);

/// Outline of a mesh seen along -z, however it lies: its widest points across each slice of its level length.
std::vector<Point2> seen_from_above(const Mesh&, const Pose& X_WM);

/// Outline of a hyper-ellipsoid seen along -z: its support points in level directions.
std::vector<Point2> seen_from_above(const engine::HyperEllipsoid&, const Pose& X_WB);

}  // namespace render
