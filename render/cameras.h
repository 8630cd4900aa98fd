// Where the viewer stands: a pure function of the camera, the recording and the time.
#pragma once

#include "engine/recording.h"
#include "render/draw_list.h"
#include "render/stage.h"

namespace render {

View view_of(const Camera&, const engine::Recording&, double time, double aspect);

/// What a camera follows, averaged over its smoothing time; the world's origin if it follows nothing.
Vec3 followed_point(const Camera&, const engine::Recording&, double time);

/// Body a name stands for: a body, a vehicle, or a person by its hips. -1: none.
int body_of_name(const engine::Recording&, const std::string& name);

}  // namespace render
