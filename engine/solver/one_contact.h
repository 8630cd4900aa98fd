// The laws of one contact, wheel or limit while all others hold still: its impulse, and how far a given one is from it.
#pragma once

#include <cmath>

#include "engine/solver/constraint.h"

namespace engine {

constexpr double kLimitArm = 0.3;  // [m] turns the speed of a joint limit into that of a limb's end, to compare residuals

/// Impulses and speeds are nowhere near overflow: the plain root, several times faster than std::hypot.
inline double length_of(double x, double y) {
  return std::sqrt(x * x + y * y);
}

/// Exact impulse of one contact with own response A (3x3), velocity b without it, normal target t and softness s (already in A).
/// `guess` is the last impulse: its tangential part starts the search for the direction of slip.
Vec3 solve_one_contact(const Mat3& A, const Vec3& b, double target, double mu, const Vec3& guess);

/// The same with friction bounded by a given impulse [N s]: the normal first, then the tangents; `old` is the last impulse, u what
/// it left.
Vec3 solve_bounded_contact(const Mat3& A, const Vec3& u, double target, double softness, double bound, const Vec3& old);

/// Nearest point of the cone |L_t| <= mu L_n.
Vec3 project_to_cone(const Vec3& impulse, double mu);

/// Impulse of a wheel with own response A, at which its contact moves at u after the impulse `old`.
Vec3 solve_wheel(const Mat3& A, const Vec3& u, const Vec3& old, const Constraint&);

/// t, or what points its way and is no longer than `most`.
Eigen::Vector2d shortened(const Eigen::Vector2d& t, double most);

/// How far [m/s] the constraint's impulse is from its law, at the velocity u it leaves; `bound` [N s] of the friction, negative:
/// Coulomb's own.
double natural_residual(const Constraint&, const Vec3& u, const Mat3& A, double bound);

}  // namespace engine
