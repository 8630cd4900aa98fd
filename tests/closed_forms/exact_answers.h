// Closed forms of the textbook scenes in scenes/gallery, for any parameters.
#pragma once

namespace exact {

constexpr double kGravity = 9.81;  // [m/s^2]

/// Thrown at vx, vz from `height` above where it slides, landing without bounce: Coulomb's impulse, then Coulomb friction.
double projectile_travel(double vx, double vz, double height, double mu);
double projectile_rest(double vx, double vz, double height, double mu);

double puck_travel(double v, double mu);
double puck_rest(double v, double mu);

/// Rebound of a ball dropped from `height` by the compliant law: e H - (1 - e) d with the depth d at the turn.
double ball_rebound(double e, double height, double mass, double stiffness);

/// Angle [rad] of a compound pendulum let go at `amplitude`: 2 asin(k cd(w t, k)), w^2 = m g l/I.
double pendulum_angle(double amplitude, double w, double t);

/// Angle [rad] between the attitudes at 0 and t of a free body with moments of inertia I, set turning at w0 (body axes). Euler's
/// equations in Jacobi's functions would do for the speeds; here both are integrated by Gragg-Bulirsch-Stoer to 1e-12.
double free_body_turned(const double I[3], const double w0[3], double t);

}  // namespace exact
