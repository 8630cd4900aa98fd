// An overlay adds lines, arrows, markers or labels to a frame. One file each, with its keys of [overlays], and one line in
// table.cpp; one that a stage does not show is not computed.
#pragma once

#include <span>

#include "engine/recording.h"
#include "render/arrange.h"

namespace render {

struct Frame {
  const Stage& stage;
  const engine::Recording& recording;
  const engine::Snapshot& now;
  const Moment& moment;
  const Camera& camera;
  double aspect = 1.78;
};

/// To the scene, as an eye in it sees it too; over it, in each pane of the picture; or to the picture as a whole.
enum class Belongs { scene, over_scene, picture };

struct Overlay {
  const char* name = "";
  std::span<const OverlayKey> keys;
  void (*add)(const Frame&, DrawList&) = nullptr;
  bool (*shown)(const Frame&) = nullptr;  // none: while its first key is on
  Belongs belongs = Belongs::over_scene;

  bool shown_in(const Frame& frame) const { return shown ? shown(frame) : frame.stage.overlays.on(keys.front().name); }
};

/// Each overlay's file ends with that of its class.
template <class T>
struct Drawn {
  static const Overlay overlay;
};

std::span<const Overlay* const> overlay_table();

/// Colour of a body part, the same in arrows, traces and legend.
Float4 colour_of_part(const std::string& body_name);

/// "pedestrian/left_thigh" -> "left thigh".
std::string readable(const std::string& body_name);

/// Ramp from dark blue to yellow whose lightness only rises, for 0..1: it reads in black and white too.
Float4 colour_of_share(double share);

}  // namespace render
