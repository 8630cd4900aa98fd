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
  bool whole_picture = false;  // belongs to the picture, not to one of its panes
};

std::span<const Overlay* const> overlay_table();

/// Colour of a body part, the same in arrows, traces and legend.
Float4 colour_of_part(const std::string& body_name);

/// "pedestrian/left_thigh" -> "left thigh".
std::string readable(const std::string& body_name);

/// Ramp from dark blue to yellow whose lightness only rises, for 0..1: it reads in black and white too.
Float4 colour_of_share(double share);

extern const Overlay kSkidMarks;
extern const Overlay kGhosts;
extern const Overlay kContactHistory;
extern const Overlay kVelocities;
extern const Overlay kDimensions;
extern const Overlay kLegend;
extern const Overlay kCharts;
extern const Overlay kTraces;
extern const Overlay kVehiclePaths;
extern const Overlay kWheelTraces;
extern const Overlay kContacts;
extern const Overlay kForces;
extern const Overlay kImpulse;
extern const Overlay kCaption;
extern const Overlay kScaleBar;
extern const Overlay kDisclaimer;

}  // namespace render
