// What the factorisation of a tree does with one link, in wide vectors where the processor has them, with the same bits on all
// processors. Matrices are 3x3 or 6x6 by columns; of six, forces and velocities stand before moments and angular velocities.
#pragma once

namespace engine {

/// A body of inertia H that hangs on a point at `r` from its centre, `r_parent` from its parent's [m]. D: how it answers with the
/// point held; X: its motion with the parent's; what the parent has to carry of it is added to H_parent. Without a parent (null)
/// X is zero.
void eliminate_point(const double* H, const double* r, const double* r_parent, double* D, double* X, double* H_parent);

/// The same where `damping` (3x3) [kg m^2] resists the turning about the point as inertia would.
void eliminate_damped_point(const double* H, const double* r, const double* r_parent, const double* damping, double* D, double* X,
                            double* H_parent);

/// The same of a body that turns about `axis` through the point; `damping` [kg m^2] resists as inertia would.
void eliminate_hinge(const double* H, const double* r, const double* r_parent, const double* axis, double damping, double* D,
                     double* X, double* H_parent);

/// The inertia of a body, of which `inertia` (3x3) has the principal moments on its diagonal, in world axes: R I R^T with R of the
/// unit quaternion q (x, y, z, w).
void turn_inertia(const double* q, const double* inertia, double* turned);

/// force -= H's first three columns by `bias` (3): what a body that its point moves by itself asks for.
void take_bias(const double* H, const double* bias, double* force);

/// force_parent += X^T force.
void pass_up(const double* X, const double* force, double* force_parent);

/// a += D force + X a_parent; no parent: null.
void answer(const double* D, const double* force, const double* X, const double* a_parent, double* a);

}  // namespace engine
