// An overlay adds lines, arrows, markers or labels to a frame. One file each, one line each in table.cpp; one that a stage does not
// show is not computed.
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

struct Overlay {
  const char* name = "";
  bool (*shown)(const Frame&) = nullptr;
  void (*add)(const Frame&, DrawList&) = nullptr;
};

std::span<const Overlay* const> overlay_table();

/// Colour of a body part, the same in arrows, traces and legend.
Float4 colour_of_part(const std::string& body_name);

/// "pedestrian/left_thigh" -> "left thigh".
std::string readable(const std::string& body_name);

extern const Overlay kSkidMarks;
extern const Overlay kTraces;
extern const Overlay kContacts;
extern const Overlay kForces;
extern const Overlay kImpulse;
extern const Overlay kCaption;
extern const Overlay kScaleBar;
extern const Overlay kDisclaimer;

}  // namespace render
