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

/// Nearest point of the cone |L_t| <= mu L_n.
Vec3 project_to_cone(const Vec3& impulse, double mu);

/// Impulse of a wheel with own response A, at which its contact moves at u after the impulse `old`.
Vec3 solve_wheel(const Mat3& A, const Vec3& u, const Vec3& old, const Constraint&);

/// How far [m/s] the constraint's impulse is from its law, at the velocity u it leaves.
double natural_residual(const Constraint&, const Vec3& u, const Mat3& A);

}  // namespace engine
