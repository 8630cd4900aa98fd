// A motion that cannot be, noticed in the step in which it begins, with its body and the effect that had it in hand.
#pragma once

#include <optional>

#include "engine/recording.h"
#include "engine/world.h"

namespace engine {

inline constexpr const char* kNotANumber = "its motion is no longer a number; a smaller step or other properties may help";

/// The first body with a place or velocity that is not a finite number or not one that can be squared, or with an attitude that is
/// no rotation; -1: none.
int lost_body(const Motion&);
/// The same of those that are not still.
int lost_body(const World&, const Motion&);

/// Failure of `body` in the step that ends at `time`, over which these conditions acted: the effect is the one whose constraint
/// pushed it hardest; where none does, its joints, or what makes it fall.
Failure failure_of(const World&, const std::vector<Constraint>&, int body, double time, const char* message);

/// Energy at the start of a run, by which the watch and the ledger measure.
void measure_energy(const World&, State&);

/// What has gone wrong, if anything: numbers that are not finite, speeds that no accident knows, or more energy out of nowhere
/// than the scene ever had. Allocates nothing while all is well.
std::optional<Failure> look_for_divergence(const World&, const State&, const std::vector<Constraint>& of_last_step);

}  // namespace engine
