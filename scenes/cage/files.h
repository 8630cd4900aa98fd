// Files inside the cage: asked for by name, handed over open.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace scenes::cage {

/// Writes to the parent; false where it is gone.
bool tell(const void* data, std::size_t bytes);

/// The bytes of a file, where the parent hands it over.
std::optional<std::string> fetch(const std::string& name);

}  // namespace scenes::cage
