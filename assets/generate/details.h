// What bodies have in common: windows, seams, wheel arches, mirrors, seats.
#pragma once

#include "assets/generate/surface.h"

namespace assets {

constexpr double kShutLine = 0.010;  // [m] between a lamp and the bodywork

using Outline = std::vector<std::array<double, 2>>;

Outline circle(double x, double z, double r, int n);
/// Rectangle in the two coordinates it is seen in.
Outline rectangle(double u0, double v0, double u1, double v1);

bool on_side(const V3& p, const V3& n);
/// The upright skin of the left side, from a height.
Filter side_above(double z);

/// A pane, or a lamp, with a black surround of a width [m].
void framed(Surface&, Seen, const Outline& pane, double surround, const Filter&, const std::string& material = "glass");
/// A dark line of a width [m] between two points of the side.
void seam(Surface&, double x0, double z0, double x1, double z1, double width = 0.009);

/// Cuts a round opening into the left side and closes it by a dark well from y = outer to y = inner.
void wheel_arch(Surface&, double x, double hub, double radius, double outer, double inner);
/// Everything that looks down, or lies below a height, becomes the dark underside.
void darken_below(Surface&, double z);

/// What a car that lies on its roof shows: exhaust, axles, tank, tunnel. `floor` is the height of its underside.
void underside(Surface&, double axle, double hub, double floor, double half_track);

/// A ball squashed to an egg, for mirrors.
Surface egg(V3 m, V3 r, const std::string& material);
/// Cushion, back and head rest; `m` is the middle of the cushion.
void seat(Surface&, V3 m, double half_width);
/// Its wheel stands at an angle [rad] to the level.
void steering_wheel(Surface&, V3 m, double radius, double lean);

}  // namespace assets
