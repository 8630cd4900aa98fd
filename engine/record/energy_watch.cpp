#include "engine/record/energy_watch.h"

#include <algorithm>
#include <cmath>

#include "engine/effects/effect.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

constexpr double kTold = 0.01;         // [-] of what was turned over
constexpr double kLeastEnergy = 1e-3;  // [-] of what the scene's masses have a metre up: what only rests turns nothing over

std::string moment(double time) {
  return std::to_string(std::lround(1e3 * time)) + " ms";
}

}  // namespace

void EnergyWatch::weigh(const State& state, const Energies& now) {
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

void EnergyWatch::close(const World& world, Diagnostics& out) const {
  const Shortfall& gain = world.log.gain;
  out.max_energy_rise = rise_;
  out.energy_turned_over = turned_over_;
  out.max_unexplained = unexplained_;
  out.max_effect_gain = gain.amount;
  const double worth = kTold * std::max(turned_over_, kLeastEnergy * scale_);
  constexpr const char* kCompare = "; see whether a smaller step says the same";
  if (unexplained_ > worth)
    out.warnings.push_back("energy: " + number(unexplained_) + " J at " + moment(at_) +
                           " that no effect explains, more than 1 % of the " + number(turned_over_) + " J turned over" + kCompare);
  if (gain.amount <= worth) return;
  const auto name = [&](int b) { return b >= 0 ? world.model.bodies[b].name : std::string("the world"); };
  const bool known = gain.body_a >= 0 || gain.body_b >= 0;
  out.warnings.push_back("energy: " + std::string(world.plan.active[static_cast<std::size_t>(world.log.gained_by)]->name) +
                         " gave " + number(gain.amount) + " J" +
                         (known ? " to " + name(gain.body_a) + " and " + name(gain.body_b) : "") + " in the step to " +
                         moment(gain.time) + ", though that effect has none to give" + kCompare);
}

}  // namespace engine
