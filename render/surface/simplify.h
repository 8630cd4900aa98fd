// Fewer triangles for a mesh that is seen small, or touched often.
#pragma once

#include <cstdint>
#include <vector>

#include "render/stage.h"

namespace render {

/// For each vertex, one vertex at the same place: corners of equal position are one, whatever their normals.
std::vector<std::uint32_t> welded(const Mesh&);

/// The parts, or all triangles as one.
std::vector<Mesh::Part> parts_of(const Mesh&);

/// Coarser triangles over the same vertices for a few tolerances; none for a mesh with few triangles or very many. No kept corner
/// lies farther than a level's tolerance from the planes of the triangles it stands for; borders of parts, open edges and creases
/// keep their lines. Edge collapse by quadric error, each vertex falling onto a neighbour (Garland & Heckbert 1997).
std::vector<Mesh::Level> coarser_levels(const Mesh&);

/// The triangles of such a level for one tolerance [m] > 0, of a mesh of any size.
std::vector<std::uint32_t> collapsed(const Mesh&, double tolerance);

}  // namespace render
