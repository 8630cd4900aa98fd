// The energy that a scene can have at any time where nothing gives it any: a bound on every speed, before the run.
#pragma once

#include "engine/model/model.h"

namespace engine {

/// Energy [J] that all bodies together can have at any time, where nothing gives any: that of the start and of falling.
double greatest_energy(const Model&);

}  // namespace engine
