// The compliant contact law of the multi-body chapter, eq. (68), (69), (74), (82), (83): numbers in, numbers out.
#pragma once

#include <algorithm>

#include "engine/math/functions.h"

namespace engine {

/// approach: surfaces close, F = S depth. separate: they part, F = e S depth, so that the share e of the energy comes back and a
/// ball rises to e times its height. resting: slower than `rest_speed`, one smooth law between the two, or a body at rest would
/// switch between them for ever.
enum class ContactPhase { open, approach, separate, resting };

/// Normal force [N] for stiffness S [N/m], share e [-], depth [m] and separating speed [m/s]. `smoothing` [m/s] is the width of
/// the resting law. A depth below zero gives a pull of the same law: the phase, not the depth, says whether surfaces touch, and a
/// step that ends a hair beyond its event must stay smooth.
inline double compliant_normal_force(double S, double e, double depth, double separating, ContactPhase phase, double smoothing) {
  switch (phase) {
    case ContactPhase::open:
      return 0;
    case ContactPhase::approach:
      return S * depth;
    case ContactPhase::separate:
      return e * S * depth;
    case ContactPhase::resting:
      return S * depth * (e + (1 - e) * 0.5 * (1 - math::tanh(separating / smoothing)));
  }
  return 0;
}

/// Share of mu F_n that acts against a slip [m/s]: all of it from `regular` [m/s] on, in proportion below. Exact for any faster
/// slip, and bounded in stiffness for the stages of Runge and Kutta; a body held on a slope creeps by less than `regular`.
inline double regularised_friction(double slip, double regular) {
  return std::min(1.0, slip / regular);
}

/// Stiffness of two surfaces pressed together: depth_1 S_1 = depth_2 S_2, depth_1 + depth_2 = depth.
inline double stiffness_in_series(double a, double b) {
  return a * b / (a + b);
}

}  // namespace engine
