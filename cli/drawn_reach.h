// What a vehicle is drawn with and has no contact with: mirrors, which fold, and would hook on all they meet were they as rigid as
// the bodywork.
#pragma once

#include <string>
#include <vector>

#include "engine/recording.h"
#include "scenes/scene.h"

namespace cli {

/// A warning for each person that such a thing reaches before anything else touches them.
std::vector<std::string> drawn_reaches(const scenes::Scene&, const engine::Recording&);

}  // namespace cli
