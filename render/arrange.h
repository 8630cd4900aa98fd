// (Stage, Recording, time) -> DrawList. No GL: most of the renderer is tested here, on numbers.
#pragma once

#include <string>

#include "engine/recording.h"
#include "render/draw_list.h"
#include "render/stage.h"

namespace render {

/// What the film shows in one frame: simulated time, the camera, and the slow-motion factor of the shot.
struct Moment {
  double time = 0;     // [s]
  std::string camera;  // name in Stage::cameras
  double speed = 1;    // [-] burnt into the caption when not 1
};

/// Moments of the whole film at `fps`, from the shots (or the whole run from the first camera).
std::vector<Moment> film(const Stage&, const engine::Recording&, double fps);

/// One frame. `aspect` = width / height. Unknown camera asserts (the loader has checked).
DrawList arrange(const Stage&, const engine::Recording&, const Moment&, double aspect);

}  // namespace render
