#include "engine/step/integration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/step/bounds.h"
#include "engine/step/step_control.h"

namespace engine {
namespace {

constexpr double kCarried = 0.02;  // [s] over which an error of speed counts as one of place: a bounce is short, its speed lasts

}  // namespace

Integration::Integration(World& world, StepBuffers& buffers) : smooth(world.model), world_(world), buffers_(buffers) {
  if (contacts_in_stages(world.model.settings)) compliant.emplace(world);
}

/// Of the step taken whole from the one in halves, as a way [m] of the body that has most of it.
double Integration::difference() const {
  const Motion &halves = buffers_.end, &whole = buffers_.whole;
  double most = 0;
  for_awake_bodies(world_, [&](int b) {
    const double turn = 2 * (halves.X_WB[b].q.coeffs() - whole.X_WB[b].q.coeffs()).norm();
    const double place = (halves.X_WB[b].p - whole.X_WB[b].p).norm() + world_.reach[b] * turn;
    const double speed =
        (halves.V_WB[b].v - whole.V_WB[b].v).norm() + world_.reach[b] * (halves.V_WB[b].w - whole.V_WB[b].w).norm();
    most = std::max(most, std::max(place, kCarried * speed) / 15);
  });
  return most;
}

double Integration::advance(const State& state, const StepControl& control, double length) {
  const Meter::Span span(world_.meter, Phase::integration);
  Motion& end = buffers_.end;
  CompliantContacts* contacts = compliant ? &*compliant : nullptr;
  const int parts = control.parts(length, smooth.fastest_swing());
  FirstStage first;  // stands where impulses act
  auto begin = [&](bool factored) {
    end = state;
    end.time = state.time + length;
    first = {&world_.impulse, factored};
    world_.loops.forget();
    if (contacts) contacts->restart(length);
  };
  auto advance_over = [&](double way) {
    if (contacts) contacts->next_part(way / parts);
    for (int k = 0; k < parts; ++k)
      smooth.advance(world_, end, way / parts, end.X_WB, end.V_WB, contacts, std::exchange(first, {}));
  };
  begin(false);
  advance_over(length);
  if (world_.model.settings.scheme != Scheme::adaptive) return 0;
  buffers_.whole = end;
  begin(true);
  advance_over(0.5 * length);
  advance_over(0.5 * length);
  return difference();
}

bool Integration::locate_contact_event(const State& state, const StepControl& control, double& length) {
  constexpr double kTight = 1e-12;  // [-] of the step
  bool any = false;
  for (int event = 0; event < 8 && compliant->first_crossing(buffers_.end, crossing); ++event) {
    any = true;
    double low = 0, high = length, f_low = crossing.start, f_high = crossing.end;
    int side = 0;
    for (int k = 0; k < 50 && high - low > kTight * length; ++k) {
      double middle = f_low < 0 ? (low * f_high - high * f_low) / (f_high - f_low) : 0.5 * (low + high);
      if (!(middle > low && middle < high)) middle = 0.5 * (low + high);
      advance(state, control, middle);
      const double f = compliant->crossing_at(buffers_.end, crossing);
      if (!std::isfinite(f) || f <= 0) {
        low = middle;
        f_low = std::isfinite(f) ? f : f_low;
        if (side == -1) f_high *= 0.5;
        side = -1;
        if (f > -1e-15 && f <= 0) {
          high = middle;
          break;
        }
      } else {
        high = middle;
        f_high = f;
        if (side == 1) f_low *= 0.5;
        side = 1;
      }
    }
    length = high;
    advance(state, control, length);
    CompliantContacts::Crossing earlier;
    if (!compliant->first_crossing(buffers_.end, earlier) || (earlier.key == crossing.key && earlier.kind == crossing.kind)) break;
  }
  return any;
}

}  // namespace engine
