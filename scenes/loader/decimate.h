// A coarser mesh for contact that is nowhere farther from the given one than a bound, either way.
#pragma once

#include <memory>

#include "engine/geometry/triangle_mesh.h"

namespace scenes {

/// The mesh itself where the bound leaves nothing to gain. Edges of sheets keep their lines.
std::shared_ptr<const engine::TriangleMesh> decimate(const std::shared_ptr<const engine::TriangleMesh>&, double tolerance);

/// True if no point of `a` is farther than `tolerance` [m] from `b`: certain, by convexity. Some surfaces within it are not
/// recognised as such, never the other way round.
bool lies_within(const engine::TriangleMesh& a, const engine::TriangleMesh& b, double tolerance);

}  // namespace scenes
