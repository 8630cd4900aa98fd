// What stands fast under wheels besides the plane: the terrain and fixed meshes, a kerb, a ramp, a bridge.
#pragma once

#include <optional>
#include <vector>

#include "engine/contact/contact.h"
#include "engine/geometry/hyper_ellipsoid_tyre.h"

namespace engine {

/// The meshes that wheels roll on, the terrain first.
std::vector<Road> roads_of(const Model&);

/// That of a body, or of the terrain; null where no wheel rolls on it.
const Road* road_of(const ContactPairs&, int body);

/// The strut's way [m], from static ride, at which the wheel's tyre just stands on the mesh, on an edge of it too. Nothing where it
/// is below `least` [m], or the two have met sideways: one that rolls up has not got farther than the last step took it.
std::optional<TyreTouch> stands_on(const Outlook&, int wheel, const Road&, double least);

/// Does the wheel mount what stands before it? Then its rim does not strike it.
bool mounts(const Outlook&, int wheel, const Road&);

}  // namespace engine
