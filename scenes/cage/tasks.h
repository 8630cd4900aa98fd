// What the caged worker does. Answers begin with 'E' and a message, or with 'M' and what was read, as parent and worker agree.
#pragma once

#include <string>

namespace scenes::cage {

/// Triangles by material (scenes/loader/mesh_cage.cpp reads them).
std::string mesh(const std::string& name);

}  // namespace scenes::cage
