// Cameras nobody has to write: the usual views of a scene, and one placed from the command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace cli {

/// top, side, front, driver, follow.
std::vector<std::string> preset_names();

/// The preset of that name for the scene; nothing where there is none. top, side, front and follow keep to the first person who
/// rides nothing, else the first vehicle, else the first body; sides are those of the first vehicle's heading. driver looks out of
/// the first vehicle. Throws UsageError for driver without a vehicle.
std::optional<render::Camera> preset_camera(const std::string& name, const scenes::Scene&);

/// A fixed camera from texts such as "6 -9 2 m"; an empty `look_at` is the middle of all bodies, an empty `lens` the default view.
/// Throws UsageError.
render::Camera camera_at(const std::string& name, const std::string& eye, const std::string& look_at, const std::string& lens,
                         const scenes::Scene&);

}  // namespace cli
