// Which side of a mesh is its outside, whatever file it came from.
#pragma once

#include <cstdint>
#include <vector>

#include "render/stage.h"

namespace render {

/// Area-weighted sums of face normals at each vertex, of length 1; (0, 0, 1) where they cancel. xyz per vertex.
std::vector<float> vertex_normals(const std::vector<float>& positions, const std::vector<std::uint32_t>& indices);

/// 1 for a body whose triangles run counter-clockwise seen from outside, -1 for one turned inside out, 0 for no body. A body
/// encloses volume; a sheet or a soup of mixed winding encloses little of its box. A tenth lies well between the two: a car fills
/// half. Nor is a terrain a body, whatever lies between it and its box: all its triangles face up, those of a body all ways.
int winding(const Mesh&);

/// Every edge is run along once each way, but for a few borders: what is laid on the body as a sheet, a missing underside.
bool of_one_winding(const Mesh&);

}  // namespace render
