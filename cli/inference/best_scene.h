// The best run as a scene of its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace cli::inference {

/// The scene file's text with these overrides ("path=12.3 m/s") put where the values stand, or below the header of the section they
/// belong to; files it names get their full path, so that it can lie anywhere.
std::string with_overrides(const scenes::Scene&, const std::vector<std::string>& overrides, const std::string& remark);

}  // namespace cli::inference
