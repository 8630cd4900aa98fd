#include "engine/step_watch.h"

#include <algorithm>

namespace engine {
namespace {

constexpr double kReadAgain = 0.01;  // [s] the processor's time is read no more often: a step is told too long by no more than that

/// The bodies most conditions are about, or the one that turns fastest where there are none.
std::array<int, 3> concerned(const World& world, const State& state, const std::vector<Constraint>& conditions) {
  std::array<int, 3> out{-1, -1, -1};
  std::array<std::ptrdiff_t, 3> most{};
  const auto count = [&](int b) {
    return std::count_if(conditions.begin(), conditions.end(),
                         [b](const Constraint& c) { return c.a.record == b || c.b.record == b; });
  };
  for (int b = 0; b < static_cast<int>(world.model.bodies.size()); ++b) {
    int body = b;
    std::ptrdiff_t number = count(b);
    for (std::size_t k = 0; k < out.size(); ++k)
      if (number > most[k]) {
        std::swap(number, most[k]);
        std::swap(body, out[k]);
      }
  }
  double fastest = -1;
  if (out[0] < 0)
    for_awake_bodies(world, [&](int b) {
      if (const double turning = state.V_WB[b].w.norm(); turning > fastest) fastest = turning, out[0] = b;
    });
  return out;
}

}  // namespace

StepWatch::StepWatch(const StepClocks& clocks) : clocks_(clocks) {
  if (!clocks_.passed) return;
  step_began_ = span_began_ = clocks_.passed();
  computed_ = clocks_.computed();
}

void StepWatch::note(const World& world, const State& state, const std::vector<Constraint>& conditions) {
  if (!clocks_.passed) return;
  const double now = clocks_.passed();
  double took = now - step_began_;
  step_began_ = now;
  if (now - span_began_ > kReadAgain) {
    // of a busy machine's time others may have had the most
    const double computed = clocks_.computed();
    took = std::min(took, computed - computed_);
    span_began_ = now;
    computed_ = computed;
  }
  if (took <= longest_) return;
  longest_ = took;
  time_ = state.time;
  bodies_ = concerned(world, state, conditions);
}

std::optional<LongestStep> StepWatch::longest(const World& world) const {
  if (!clocks_.passed) return std::nullopt;
  LongestStep out{longest_, time_, {}};
  for (const int b : bodies_)
    if (b >= 0) out.bodies.push_back(world.model.bodies[b].name);
  return out;
}

}  // namespace engine
