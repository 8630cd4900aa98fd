#include "engine/divergence.h"

#include <algorithm>
#include <cmath>

#include "engine/effects/effect.h"

namespace engine {
namespace {

constexpr double kFastest = 2e3;  // [m/s], [rad/s] * 10: nothing in a traffic accident moves like this
constexpr double kFall = 1;  // [m] on earth: what lies still, or floats between loaded springs, has no energy to be measured by

double speed_of(const Twist& V) {
  return V.v.norm() + V.w.norm() / 10;
}

/// Whether one of those that are not still is faster than that; no roots of all the others at every step.
bool any_too_fast(const World& world, const State& state) {
  return std::any_of(world.still.others.begin(), world.still.others.end(), [&](int b) {
    const Twist& V = state.V_WB[b];
    return V.v.squaredNorm() + V.w.squaredNorm() / 100 > kFastest * kFastest / 2 && speed_of(V) > kFastest;
  });
}

/// Of those that are not still.
int fastest_body(const World& world, const State& state) {
  return *std::max_element(world.still.others.begin(), world.still.others.end(),
                           [&](int a, int b) { return speed_of(state.V_WB[a]) < speed_of(state.V_WB[b]); });
}

bool is_lost(const Pose& X, const Twist& V) {
  // what has no square is no number either, and is noticed before a product makes it so; of NaN the comparison is false
  static constexpr double kLargestSquare = 1e200;
  const auto is_number = [](const Vec3& v) { return v.squaredNorm() < kLargestSquare; };
  return !is_number(X.p) || !is_number(V.v) || !is_number(V.w) || !(std::abs(X.q.squaredNorm() - 1) < 1e-3);
}

double energy_of(const World& world, const State& state) {
  return kinetic_energy(world.model, state) + potential_energy(world.model, state) + state.energy.springs;
}

}  // namespace

int lost_body(const Motion& state) {
  for (std::size_t b = 0; b < state.X_WB.size(); ++b)
    if (is_lost(state.X_WB[b], state.V_WB[b])) return static_cast<int>(b);
  return -1;
}

int lost_body(const World& world, const Motion& state) {
  for (const int b : world.still.others)
    if (is_lost(state.X_WB[b], state.V_WB[b])) return b;
  return -1;
}

Failure failure_of(const World& world, const std::vector<Constraint>& conditions, int body, double time, const char* message) {
  const bool jointed = std::any_of(world.model.joints.begin(), world.model.joints.end(),
                                   [body](const Joint& j) { return j.parent == body || j.child == body; });
  const char* effect = jointed ? "joints" : "gravity";
  double largest = -1;
  for (const Constraint& c : conditions)
    if ((c.a.body == body || c.b.body == body) && !(c.impulse.norm() <= largest)) {
      largest = c.impulse.norm();
      effect = world.plan.active[c.effect]->name;
    }
  return {time, world.model.bodies[body].name, effect, message};
}

void measure_energy(const World& world, State& state) {
  state.energy.initial = energy_of(world, state);
  state.energy.scale = kinetic_energy(world.model, state) + state.energy.springs;
  for (const Body& body : world.model.bodies)
    if (!body.fixed) state.energy.scale += body.mass * std::max(kGravity, world.model.settings.gravity.norm()) * kFall;
}

std::optional<Failure> look_for_divergence(const World& world, const State& state, const std::vector<Constraint>& of_last_step) {
  if (world.log.failure) return world.log.failure;
  if (const int body = lost_body(world, state); body >= 0) return failure_of(world, of_last_step, body, state.time, kNotANumber);
  if (world.still.others.empty()) return std::nullopt;
  if (any_too_fast(world, state))
    return failure_of(world, of_last_step, fastest_body(world, state), state.time,
                      "the motion left every physical bound: a smaller step or other properties may help");
  // what springs give back stands in the books as negative dissipation
  double unexplained =
      mechanical_energy(world, state) + state.energy.springs - state.energy.initial - std::max(0.0, state.energy.added);
  for (const double d : state.energy.dissipated) unexplained += std::min(0.0, d);
  if (unexplained > state.energy.scale)
    return failure_of(world, of_last_step, fastest_body(world, state), state.time,
                      "the scene gained more energy than it ever had; a smaller step may help");
  return std::nullopt;
}

}  // namespace engine
