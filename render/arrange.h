// (Stage, Recording, time) -> DrawList. No GL: most of the renderer is tested here, on numbers.
#pragma once

#include "engine/recording.h"
#include "render/draw_list.h"
#include "render/frames.h"
#include "render/stage.h"

namespace render {

/// What of a frame is wanted: all of it; the scene with what hangs on it, for one pane of a shared picture; or what concerns the
/// whole picture (caption, legend, charts), to be laid over the panes.
enum class Layer { all, scene, sheet };

/// One frame from Moment::camera. `aspect` = width / height. Unknown camera asserts (the loader has checked).
DrawList arrange(const Stage&, const engine::Recording&, const Moment&, double aspect, Layer = Layer::all);

/// A mesh in its paint.
MeshItem placed(const std::shared_ptr<const Mesh>&, const Pose& X_WM, const std::vector<Material>& repaint);

/// The meshes of a body and its wheels as they stand at one instant: still, in the world.
std::vector<MeshActor> standing(const Stage&, int body, const engine::Snapshot&);

/// The skin of a person (of look `skin`) at one instant.
SkinItem bent_skin(const PersonActor&, const engine::Snapshot&);

}  // namespace render
