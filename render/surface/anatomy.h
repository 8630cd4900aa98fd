// How parts of a body look, beyond the hyper-ellipsoids that stand for them: a wrist and a hand, a calf, a nose. For looking only;
// what touches is the hyper-ellipsoid. Known by the words of the library (forearm, calf ...); other parts stay as they are.
#pragma once

#include <string_view>

#include "engine/geometry/hyper_ellipsoid.h"

namespace render {

using engine::Vec3;

struct Anatomy;

/// Of a segment by its name ("pedestrian/left_calf" or "left_calf"); null if there is none.
const Anatomy* anatomy_of(std::string_view segment);

/// Distance-like, as along rays from the centre: negative inside. x in the segment's axes (x forward, y left, z up when standing);
/// `mirrored` for the right side.
double anatomical_distance(const Anatomy&, const engine::HyperEllipsoid&, bool mirrored, const Vec3& x);

/// Along the ray from the centre; exact on the surface and for balls.
double radial_distance(const engine::HyperEllipsoid&, const Vec3& x);

/// [m] grows from the hairline into the hair, which is high over the face and low at the neck. x in the head's axes.
double beyond_hairline(const Vec3& x, const Vec3& head_axes);

/// Minimum with a fillet of width k (I. Quilez, polynomial form).
double smooth_minimum(double a, double b, double k);

}  // namespace render
