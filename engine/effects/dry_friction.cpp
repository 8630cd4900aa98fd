#include "engine/effects/dry_friction.h"

#include <algorithm>
#include <cmath>

namespace engine {
namespace {

constexpr double kStuckRate = 1e-5;  // [rad/s], [m/s] at which dry friction gives way: 0.6 mrad or mm in a minute at most
constexpr double kMayGrow = 1.5;     // [-] in a step, of the rate that is looked ahead
constexpr double kMayLetGo = 4;      // [-] the same, of one that was held back: more would let what rests creep
constexpr double kHeldBack = 1e-3;   // [rad/s], [m/s] by more friction than the given: the impulses are found again
constexpr double kSurelySlides = 2;  // [-] times what friction takes from the rate in a step, were both bodies free

/// The rate [rad/s], [m/s] at which a coordinate that goes at `now` and is looked for at `ahead` is expected to come out of the
/// step: faster by what the last step held back beyond the friction given, and never slower. A damper of the rate there is brings a
/// slow one to rest in a few steps by itself; one expected at rest too soon would be torn loose and all impulses found again.
double expect_slip(double now, double ahead, double held_back) {
  const double rate = std::abs(now);
  if (held_back > 0) return std::max(std::min(rate + held_back, kMayLetGo * rate), kStuckRate);
  if (rate < kMayGrow * kStuckRate) return kStuckRate;
  return std::clamp(std::copysign(1.0, now) * ahead, rate, kMayGrow * rate);
}

/// What the friction takes from the rate in a step, were both bodies free [rad/s], [m/s].
double taken_by_friction(const StepContext& step, int j, int i, const Vec3& axis) {
  return step.length * step.world.model.joints[j].coordinate(i).friction * coordinate_response(step, j, i, axis);
}

}  // namespace

double coordinate_response(const StepContext& step, int j, int i, const Vec3& axis) {
  const Model& model = step.world.model;
  const Joint& joint = model.joints[j];
  double response = 0;
  for (const int b : {joint.parent, joint.child}) {
    if (b < 0 || model.bodies[b].fixed) continue;
    const Vec3 axis_B = step.state.X_WB[b].q.conjugate() * axis;
    response += i == kSlide ? 1 / model.bodies[b].mass : axis_B.dot(axis_B.cwiseQuotient(model.bodies[b].inertia_B.diagonal()));
  }
  return response;
}

void add_friction(StepContext& step, const FrictionMemory& last, int j, int i) {
  Resistance& resistance = step.buffers.resistances[j];
  JointDamper& damper = step.buffers.dampers[j];
  const double friction = step.world.model.joints[j].coordinate(i).friction, now = resistance.rate[i], h = step.length;
  const double ahead = now + h * last.change[j][i];
  const Vec3 axis = resistance.at_start.axes_W.col(i);
  if (std::min(std::abs(now), std::abs(ahead)) > kSurelySlides * taken_by_friction(step, j, i, axis)) {
    (i == kSlide ? resistance.force_W : resistance.torque_W) -= std::copysign(friction, ahead) * axis;
    damper.present = true;
  } else {
    const double rate = resistance.slip_rate[i] = expect_slip(now, ahead, last.held_back[j][i]);
    (i == kSlide ? damper.sliding : damper.turning) += h * friction / rate * axis * axis.transpose();
  }
}

bool gave_way(StepContext& step, int j) {
  const Joint& joint = step.world.model.joints[j];
  JointDamper& damper = step.buffers.dampers[j];
  Resistance& resistance = step.buffers.resistances[j];
  bool any = false;
  for (int i = 0; i < kCoordinates; ++i) {
    const double friction = joint.coordinate(i).friction, assumed = resistance.slip_rate[i];
    if (friction <= 0 || assumed <= 0) continue;
    const Vec3 axis = resistance.at_start.axes_W.col(i);
    const double came_out = std::abs(axis.dot(part_of(resistance.after, i)));
    resistance.held_back[i] = 0;
    if (came_out <= assumed) continue;
    const double held_back = taken_by_friction(step, j, i, axis) * (came_out / assumed - 1);
    if (held_back < kHeldBack) continue;
    resistance.held_back[i] = held_back;
    if (came_out <= kMayGrow * assumed) continue;
    const double rate = resistance.slip_rate[i] = came_out + held_back;
    (i == kSlide ? damper.sliding : damper.turning) += step.length * friction * (1 / rate - 1 / assumed) * axis * axis.transpose();
    any = true;
  }
  return any;
}

}  // namespace engine
