// How near each other came what never touched.
#pragma once

#include <optional>

#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

struct Approach {
  double distance = 0;  // [m] 0: they touched, or overlap seen from above
  double time = 0;      // [s]
  int body_a = -1, body_b = -1;
};

/// The nearest that a person's part and a vehicle came, and else two vehicles, at a recorded instant; nothing where a vehicle
/// touched a person or another vehicle in the run, or there are no two of them. A part against a vehicle: between the surfaces
/// (contacts_with_mesh). Two vehicles: between the convex outlines of their meshes seen from above.
std::optional<Approach> nearest_approach(const Model&, const Recording&);

}  // namespace engine
