// A flat side of a hyper-ellipsoid touches at many points: a handful of exact surface points stands for them.
#pragma once

#include <array>

#include "engine/geometry/hyper_ellipsoid.h"

namespace engine {

/// From this exponent on a side counts as flat. Below it the one deepest point is stable.
constexpr double kFlatExponent = 4;

/// [m] A deepest point this little below the corners is one of them, and jumps: left out.
constexpr double kNoDeeper = 5e-6;

/// From this exponent on a body stands on its corners, whatever its size, and lies with a flat side on another.
constexpr double kFlatSides = 8;

/// [-] By how much the directions of a side's corners lean, in the affine image where the body is a cube: (1e-3)^(1/29) = 0.79 of
/// the half widths is where the support point of n = 30 goes; the face is lifted there by 3e-5 of its depth.
constexpr double kCornerLean = 1e-3;

/// Directions (body axes, unit) whose support points surround the deepest one on the side that faces `direction` (unit, body
/// axes): direction leaned a little towards the four diagonals of the two other body axes. On a face that lies flat the points
/// stand at 0.8 of the half widths and within some micrometres of the face.
std::array<Vec3, 4> corner_directions(const HyperEllipsoid&, const Vec3& direction, double lean);
/// Leaned by kCornerLean; less where the corners of a thick body would then stand too high to carry it: it would rock on its
/// deepest point for ever.
std::array<Vec3, 4> corner_directions(const HyperEllipsoid&, const Vec3& direction);

/// May the corners of the side that faces `direction` (body axes) carry for its deepest point at any tilt? Lying flat, they stand
/// above it by most.
bool corners_carry(const HyperEllipsoid&, const Vec3& direction);

}  // namespace engine
