// The last step of every file written: it appears under its name only when it is whole and kept by the disk.
#pragma once

#include <filesystem>

namespace render {

/// Writes `part` through to the disk, renames it to `file` and writes the folder's entry through: after a kill or a power cut the
/// name holds the old file or the new one, whole. Throws RenderError.
void publish(const std::filesystem::path& part, const std::filesystem::path& file);

}  // namespace render
