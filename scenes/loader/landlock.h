#pragma once

#include <filesystem>

namespace scenes {

/// From now on this process can read files below `root` and nothing else: no other path, no writing, no TCP. Uses the kernel's
/// Landlock; false where the kernel has none, or it is switched off.
bool confine_to(const std::filesystem::path& root);

}  // namespace scenes
