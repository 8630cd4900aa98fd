// Which panel of a vehicle each triangle of its collision mesh is, by the material drawn nearest to it and by its place.
#pragma once

#include <memory>

#include "engine/geometry/panels.h"
#include "render/stage.h"

namespace scenes {

/// `look` and `solid` share a frame: x forward, z up. Glass that faces forwards is the windscreen; before it what faces up is the
/// bonnet, with the wings beside its foot; beside it the pillars, above it the edge of the roof; low behind it the lid of a boot is
/// rear. Without glass normals alone tell front, side, rear and roof.
std::shared_ptr<const engine::Panels> panels_of(const engine::TriangleMesh& solid, const render::Mesh& look);

}  // namespace scenes
