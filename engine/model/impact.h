#pragma once

#include <optional>

#include "engine/math/types.h"

namespace engine {

/// What the user settles about the Kudlich-Slibar impacts of one pair of bodies; what is left open is found.
struct ImpactSettings {
  int body_a = -1, body_b = -1;
  double penetration_time = 0.03;     // [s] t_P, from the first touch to the exchange: "depth of penetration"
  std::optional<Vec3> point_W;        // [m] of the first impact; later ones are found
  std::optional<Vec3> normal_W;       // of the contact plane of the first impact, either sign
  std::optional<double> friction;     // [-]
  std::optional<double> restitution;  // [-] multiplies the whole impulse
};

}  // namespace engine
