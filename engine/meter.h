// What a run spends on what. Who wants to know hands in a clock; without one a call is counted and nothing else.
#pragma once

#include <array>
#include <vector>

#include "engine/recording.h"

namespace engine {

/// A clock handed in by those who want the cost per effect; the engine has none of its own.
using Clock = double (*)();

/// Clocks of those who want to know which step took longest: one that goes on [s], and the time this process has computed [s],
/// which takes a call of the system and is read only now and then.
struct StepClocks {
  Clock passed = nullptr;
  Clock computed = nullptr;
};

/// Parts of the step that serve several effects at once.
enum class Phase { integration, impulses, joint_projection, recording, rest };

/// Time goes to the innermost span alone, so that the costs add up to the run.
class Meter {
 public:
  explicit Meter(Clock clock) : clock_(clock) { turn_to(&of(Phase::rest)); }
  Meter(const Meter&) = delete;

  std::vector<EffectCost> effects;  // in the order of the plan; not to grow once the run has begun
  std::vector<EffectCost> phases{
      {"integration", 0, 0}, {"impulses", 0, 0}, {"joint_projection", 0, 0}, {"recording", 0, 0}, {"rest", 0, 0}};

  EffectCost& of(Phase phase) { return phases[static_cast<std::size_t>(phase)]; }
  void finish() { turn_to(nullptr); }

  class Span {
   public:
    Span(Meter& meter, std::size_t effect) : Span(meter, meter.effects[effect]) {}
    Span(Meter& meter, Phase phase) : Span(meter, meter.of(phase)) {}
    ~Span() { meter_.turn_to(outer_); }
    Span(const Span&) = delete;

   private:
    Span(Meter& meter, EffectCost& cost) : meter_(meter), outer_(meter.current_) {
      ++cost.calls;
      meter.turn_to(&cost);
    }
    Meter& meter_;
    EffectCost* outer_;
  };

 private:
  void turn_to(EffectCost* next) {
    if (clock_) {
      const double now = clock_();
      if (current_) current_->wall_s += now - since_;
      since_ = now;
    }
    current_ = next;
  }

  Clock clock_;
  EffectCost* current_ = nullptr;
  double since_ = 0;  // [s] when the current span began or went on
};

}  // namespace engine
