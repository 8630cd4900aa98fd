// Parts of persons that got faster than blows and swings make them: pinched between rigid surfaces, like a pip between fingers.
#pragma once

#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

/// A warning for each person, of the fastest of its parts.
std::vector<std::string> flung_parts(const Model&, const Recording&);

}  // namespace engine
