// The impulse model of Kudlich and Slibar: one impulse at one point of a contact plane, in closed form.
//
// With u the velocity of body 1's point against body 2's, n the contact normal (from 2 to 1), P the impulse on 1:
//   u' = u + K P,   K = (1/m1 + 1/m2) 1 - [r1]x I1^-1 [r1]x - [r2]x I2^-1 [r2]x
//   full impact      P_c = -K^-1 u ends all relative motion at the point;  P = (1 + e) P_c
//   sliding impact   if |P_t| > mu |P_n|:  P = P_n (n + mu t), t = P_t / |P_t|,  P_n = -(1 + e) (u.n) / (n . K (n + mu t))
//   energy lost      -1/2 P.(u + u')
// It is never negative. With a = n.Kn, b = n.Kt, c = t.Kt and P_c = p n + q t, q > mu p, closing means p a + q b > 0, hence
// n.K(n + mu t) = a + mu b > 0, and at e = 1 the loss of a sliding impact has the sign of mu (q - mu p)(a c - b^2) > 0.
// Sources: H. Kudlich, Beitrag zur Mechanik des Kraftfahrzeug-Verkehrsunfalls, TU Wien 1966; A. Slibar, 1966.
#pragma once

#include "engine/math/types.h"

namespace engine {

struct PlaneImpact {
  Vec3 impulse = Vec3::Zero();   // [N s] on body 1; zero if the points do not close along the normal
  Vec3 u_after = Vec3::Zero();   // [m/s]
  double energy_lost = 0;        // [J] >= 0
  double required_friction = 0;  // [-] that a full impact would need; above it the impact is a full one
  bool sliding = false;
};

/// K of two free rigid bodies: masses [kg], inertias about the centres in world axes, levers from the centres to the point [m].
Mat3 impact_matrix(double mass_1, const Mat3& inertia_1, const Vec3& r_1, double mass_2, const Mat3& inertia_2, const Vec3& r_2);

/// `K` symmetric positive definite, also that of jointed bodies; `normal` unit, from 2 to 1; friction >= 0, restitution 0..1.
PlaneImpact kudlich_slibar(const Mat3& K, const Vec3& u, const Vec3& normal, double friction, double restitution);

}  // namespace engine
