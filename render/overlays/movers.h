// How those move whose speed is told: a vehicle or body by itself, a person with all its parts.
#pragma once

#include "engine/recording.h"
#include "render/stage.h"

namespace render {

/// Centre of mass, world axes, [m].
Vec3 centre_of(const Mover&, const engine::Snapshot&);

/// Of the centre of mass, world axes, [m/s].
Vec3 velocity_of(const Mover&, const engine::Snapshot&);

}  // namespace render
