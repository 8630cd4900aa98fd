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

/// Work [J] that presses a spring in by `depth` if its force grows no further than `yield` [N].
inline double work_of_yielding_spring(double S, double yield, double depth) {
  const double sprung = std::min(depth, yield / S);
  return S * sprung * (depth - 0.5 * sprung);
}

/// What a part that yields adds to its spring [N] because it cannot be pressed in by more than `room` [m]: the energy of `mass`
/// [kg] closing at `closing` [m/s] that the spring cannot take up before, evenly over the way left. Nothing while it can. Tissue
/// bottoms out on bone, a panel on what lies behind it, and blows faster than the spring bears meet a force that grows with speed
/// and is not given back (R. W. G. Anderson, A. D. Long, T. Serre, Nonlinear Dynamics 58, 2009).
inline double bottoming_force(double S, double yield, double depth, double closing, double mass, double room) {
  constexpr double kLeastWay = 0.05;  // [-] of the room
  if (!(closing > 0) || !(depth > 0)) return 0;
  const double left = work_of_yielding_spring(S, yield, room) - work_of_yielding_spring(S, yield, depth);
  const double beyond = 0.5 * mass * closing * closing - left;
  return std::max(0.0, beyond / std::max(room - depth, kLeastWay * room));
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
