// A motion that cannot be, noticed in the step in which it begins, with its body and the effect that had it in hand.
#pragma once

#include <optional>

#include "engine/recording.h"
#include "engine/world.h"

namespace engine {

inline constexpr const char* kNotANumber = "its motion is no longer a number; a smaller step or other properties may help";

/// The first body with a place or velocity that is not a finite number or not one that can be squared, or with an attitude that is
/// no rotation; -1: none.
int lost_body(const State&);

/// Failure of `body` in the step that ends at `time`: the effect is the one whose constraint pushed it hardest; where none
/// does, its joints, or what makes it fall.
Failure failure_of(const World&, int body, double time, const char* message);

class DivergenceWatch {
 public:
  DivergenceWatch(const World&, const State&);

  /// What has gone wrong, if anything: numbers that are not finite, speeds that no accident knows, or more energy out of nowhere
  /// than the scene ever had. Allocates nothing while all is well.
  std::optional<Failure> look(const World&, const State&) const;

 private:
  double initial_ = 0;  // [J] kinetic and potential at the start
  double scale_ = 0;    // [J] of the scene
};

}  // namespace engine
