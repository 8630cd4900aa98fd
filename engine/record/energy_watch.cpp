#include "engine/record/energy_watch.h"

#include <algorithm>
#include <cmath>

#include "engine/effects/effect.h"
#include "engine/effects/words.h"
#include "engine/joints/coordinates.h"

namespace engine {
namespace {

constexpr double kTold = 0.01;         // [-] of what was turned over
constexpr double kToldOfMuch = 1e-3;   // [-] the same of more than one step may mislay
constexpr double kMuch = 10;           // [J] and that is so much: kMayMislay of an island in a step, which this room may not know
constexpr double kLeastEnergy = 1e-3;  // [-] of what the scene's masses have a metre up: what only rests turns nothing over

constexpr double kGift = 0.1;     // [-] of what was turned over: springs give back, and no more than they took
constexpr double kLeastGift = 5;  // [J]

/// [J] that the springs of joints hold.
double in_springs(const Model& model, const Motion& at) {
  double out = 0;
  for (const Joint& joint : model.joints) {
    const JointCoordinates now = joint_coordinates(joint, joint.parent >= 0 ? at.X_WB[joint.parent] : Pose{}, at.X_WB[joint.child]);
    for (int i = 0; i < kCoordinates; ++i) {
      const JointCoordinate& a = joint.coordinate(i);
      if (now.free[i]) out += 0.5 * a.stiffness * (now.value[i] - a.rest) * (now.value[i] - a.rest);
    }
  }
  return out;
}

std::string moment(double time) {
  return std::to_string(std::lround(1e3 * time)) + " ms";
}

}  // namespace

void EnergyWatch::weigh(const World& world, const State& state, const Energies& now) {
  if (!begun_) stored_ = in_springs(world.model, state), dissipated_before_ = now.dissipated;
  dissipated_ = now.dissipated;
  const double mechanical = now.kinetic + now.potential - now.added;
  if (begun_) rise_ = std::max(rise_, mechanical - mechanical_);
  begun_ = true;
  mechanical_ = mechanical;
  scale_ = state.energy.scale;
  double turned_over = now.kinetic + std::abs(now.added);
  for (const double d : now.dissipated) turned_over += std::abs(d);
  turned_over_ = std::max(turned_over_, turned_over);
  if (std::abs(now.residual) <= unexplained_) return;
  unexplained_ = std::abs(now.residual);
  at_ = state.time;
}

/// Surfaces and joints that yield may give within a step what they took before. Over a run they have nothing to give but what they
/// held at the start.
void EnergyWatch::tell_of_gifts(const World& world, Diagnostics& out) const {
  if (!world.log.overlaps.empty()) return;  // what is moved apart is given that
  for (std::size_t e = 0; e < dissipated_.size(); ++e) {
    const EffectKind& kind = *world.plan.active[e];
    const double given = dissipated_before_[e] - dissipated_[e] - stored_;
    if (!kind.passive || given < std::max(kLeastGift, kGift * turned_over_)) continue;
    out.warnings.push_back("energy: " + std::string(kind.name) + " gave " + number(given) +
                           " J over the run, and had none to give: what rests or lies in that time may creep, do not rely on it; a "
                           "smaller step gives less");
  }
}

void EnergyWatch::close(const World& world, Diagnostics& out) const {
  const Shortfall& gain = world.log.gain;
  out.max_energy_rise = rise_;
  out.energy_turned_over = turned_over_;
  out.max_unexplained = unexplained_;
  out.max_effect_gain = gain.amount;
  const double of = std::max(turned_over_, kLeastEnergy * scale_), worth = kTold * of;
  constexpr const char* kCompare = "; see whether a smaller step says the same";
  if (unexplained_ > std::clamp(kMuch, kToldOfMuch * of, worth))
    out.warnings.push_back("energy: " + number(unexplained_) + " J at " + moment(at_) + " that no effect explains, of " +
                           number(turned_over_) + " J turned over" + kCompare);
  tell_of_gifts(world, out);
  if (gain.amount <= worth) return;
  const auto name = [&](int b) { return b >= 0 ? world.model.bodies[b].name : std::string("the world"); };
  const bool known = gain.body_a >= 0 || gain.body_b >= 0;
  out.warnings.push_back("energy: " + std::string(world.plan.active[static_cast<std::size_t>(world.log.gained_by)]->name) +
                         " gave " + number(gain.amount) + " J" +
                         (known ? " to " + name(gain.body_a) + " and " + name(gain.body_b) : "") + " in the step to " +
                         moment(gain.time) + ", though that effect has none to give" + kCompare);
}

}  // namespace engine
