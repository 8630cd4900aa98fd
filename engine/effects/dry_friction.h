// Dry friction of the joints' coordinates over a step.
#pragma once

#include <tuple>
#include <vector>

#include "engine/step_context.h"

namespace engine {

/// What the last step told of joints with dry friction; per joint, per coordinate.
struct FrictionMemory {
  std::vector<Eigen::Vector4d> change;     // [rad/s^2], [m/s^2] of the rate
  std::vector<Eigen::Vector4d> held_back;  // [rad/s], [m/s] of the rate, by more friction than the given

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.change, s.held_back);
  }
};

/// How the rate of a coordinate answers an impulse along its unit axis, were both bodies free: 1/I [1/(kg m^2)], of a slide 1/m
/// [1/kg].
double coordinate_response(const StepContext&, int joint, int coordinate, const Vec3& axis);

/// Dry friction of a coordinate whose rate is known acts with the torque given where it is sure to slide at the end of the step,
/// looked ahead from the last one. Elsewhere it may hold: it acts as a damper that yields the torque at the rate expected.
void add_friction(StepContext&, const FrictionMemory&, int joint, int coordinate);

/// Where a joint was torn loose the rate it was expected at was far too small and the joint all but rigid: expects the rate at
/// which it would have come out with the torque given, by its own inertia; true if the impulses are to be found again. What was
/// held back by less than half as much friction again as given is left to the next step.
bool gave_way(StepContext&, int joint);

}  // namespace engine
