// The hyper-ellipsoid |x/a|^n + |y/b|^n + |z/c|^n = 1, eq. (60): the shape of every body segment.
#pragma once

#include <array>

#include "engine/math/types.h"

namespace engine {

/// Centre at the body's origin, principal axes along the body's axes.
struct HyperEllipsoid {
  Vec3 semi_axes{0.1, 0.1, 0.1};  // [m] a, b, c > 0
  double exponent = 2;            // [-] n >= 2, need not be an integer; 2 ellipsoid, 30 almost a box
};

/// Enclosed volume [m^3] = 8abc G(1+1/n)^3 / G(1+3/n).
double volume(const HyperEllipsoid&);

/// Inertia about the centre for a mass [kg] evenly spread: diagonal of the tensor in body axes [kg m^2] (3).
Vec3 principal_inertia(const HyperEllipsoid&, double mass);

/// Support function h(d) = max d.x over the body and the point where it is reached: the same powers serve both.
/// Source: dual norm of the hyper-ellipsoid, 1/n + 1/q = 1.
struct Support {
  double value = 0;  // [m * |d|]
  Vec3 point;        // [m] body axes
};

/// d in body axes, need not be unit; zero asserts.
Support support(const HyperEllipsoid&, const Vec3& direction);

/// A support but for its scale sum^(-1/n) [-]: those of two bodies take no more time than that of one.
struct UnscaledSupport {
  Support of;
  double sum = 1, n = 2;
};

/// d as of support().
UnscaledSupport unscaled_support(const HyperEllipsoid&, const Vec3& direction);

/// Of two bodies what support() says of each, to the last bit.
std::array<Support, 2> scaled(const UnscaledSupport&, const UnscaledSupport&);

/// Value alone; zero for no direction.
double support_value(const HyperEllipsoid&, const Vec3& direction);

/// No less than the value and at most 5 % more, exact for n = 2; it asks for no powers.
double support_bound(const HyperEllipsoid&, const Vec3& direction);

/// Point alone: of the surface the farthest along `direction` [m] (3).
Vec3 support_point(const HyperEllipsoid&, const Vec3& direction);

/// Hessian of the support function at `direction` (unit, body axes) [m], 3x3, from what support() says there. Infinite curvature
/// radii are capped.
Mat3 support_hessian(const HyperEllipsoid&, const Vec3& direction, const Support&);

/// Gauge N(x) = (|x/a|^n + |y/b|^n + |z/c|^n)^(1/n): 1 on the surface, < 1 inside, homogeneous of degree one. Along its gradient
/// points the outward normal. Zero x gives zeros. The same powers serve both.
struct GaugeAt {
  double value;   // [-]
  Vec3 gradient;  // [1/m]
};
GaugeAt gauge_at(const HyperEllipsoid&, const Vec3& x);
double gauge(const HyperEllipsoid&, const Vec3& x);
Vec3 gauge_gradient(const HyperEllipsoid&, const Vec3& x);

/// Hessian of the gauge [1/m^2], 3x3.
Mat3 gauge_hessian(const HyperEllipsoid&, const Vec3& x);

/// Outward unit normal at surface point x (body axes).
Vec3 outward_normal(const HyperEllipsoid&, const Vec3& x);

/// Surface point along the ray from the centre; direction need not be unit, zero asserts.
Vec3 radial_point(const HyperEllipsoid&, const Vec3& direction);

/// Half widths of the world-axis-aligned box around a body rotated by q_WB [m] (3); exact.
Vec3 aabb_half_widths(const HyperEllipsoid&, const Quat& q_WB);

}  // namespace engine
