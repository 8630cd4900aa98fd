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
  Layout layout = Layout::single;
  std::string second{};  // the other camera of a shared picture
  int card = -1;         // index into Stage::cards: a page of text in place of the scene
  int shot = -1;         // which shot this belongs to; chapters begin where it changes
};

/// Moments of the whole film at `fps`, from the shots (or the whole run from the first camera).
std::vector<Moment> film(const Stage&, const engine::Recording&, double fps);

/// What of a frame is wanted: all of it; the scene with what hangs on it, for one pane of a shared picture; or what concerns the
/// whole picture (caption, legend, charts), to be laid over the panes.
enum class Layer { all, scene, sheet };

/// One frame from Moment::camera. `aspect` = width / height. Unknown camera asserts (the loader has checked).
DrawList arrange(const Stage&, const engine::Recording&, const Moment&, double aspect, Layer = Layer::all);

/// The skin of a person (of look `skin`) at one instant.
SkinItem bent_skin(const PersonActor&, const engine::Snapshot&);

}  // namespace render
