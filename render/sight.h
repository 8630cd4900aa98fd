// What stands between: how far an eye sees before it meets something solid.
#pragma once

#include "engine/recording.h"
#include "render/stage.h"

namespace render {

/// The share of a straight way that is free of what the meshes of a stage are for touch, and of the ground: 1 all of it.
double free_share(const Stage&, const engine::Snapshot&, const Vec3& from, const Vec3& way);

/// The camera itself, or a person's eye that has backed off past its own head: pressed against bodywork or the ground it would look
/// into them.
Camera held_outside(const Stage&, const engine::Snapshot&, const Camera&);

}  // namespace render
