// Minute perturbations: changes far below anything that can be measured at the scene of an accident. What they do to the answer is
// its sensitivity, which no smaller step removes.
#pragma once

#include "engine/model/model.h"

namespace cli::study {

constexpr double kPerturbedPosition = 1e-6;  // [m] each horizontal direction
constexpr double kPerturbedSpeed = 1e-6;     // of every velocity and of gravity

constexpr double kStartGrid = 0x1p-26;  // [m] on which several bodies start (engine/local_frame.h)

/// Another start that the grid could as well have made of the scene: every place shifted by a grid's width at most, and rounded to
/// it.
void start_elsewhere(engine::Model&, int draw);

/// Member 0 is the model itself. Bodies tied together by joints are moved as one, so that no joint opens; what is tied to the world
/// keeps its place. The same member is the same perturbation at every setting.
void perturb(engine::Model&, int member);

}  // namespace cli::study
