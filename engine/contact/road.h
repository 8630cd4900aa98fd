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
/// is below `least` [m], too steep to the tyre, or met sideways.
std::optional<TyreTouch> stands_on(const Outlook&, int wheel, const Road&, double least);

/// Does the wheel's tyre stand on the mesh, wherever it is in its stroke?
bool carries(const Outlook&, int wheel, const Road&);

/// Does the wheel mount what a point of it, `radius` [m] from its axle, meets there? Then that does not strike the rim.
bool mounts(const Outlook&, int wheel, double radius, const Road&, const SurfaceContact&);

}  // namespace engine
