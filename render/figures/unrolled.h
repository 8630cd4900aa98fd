// A vehicle unrolled: along a taut tape over its longitudinal section, from the ground up over front, bonnet, windscreen and roof,
// against the place across.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/recording.h"
#include "render/figures/outline.h"

namespace render {

/// The tape: the upper front of the section's convex outline, from the ground to the end of the roof; x forward, z up, body frame.
/// Empty where the body has no mesh.
std::vector<Point2> tape_of(const Stage&, int body, double ground);

/// Length along the tape to the place on it nearest to p, and how far p is from it.
struct OnTape {
  double along = 0, off = 0;  // [m]
};
OnTape on_tape(const std::vector<Point2>& tape, const Point2& p);

/// Whether a touch of a vehicle that stands at `X_WB`, so far `off` the tape [m], is of what the tape lies on or passes: front with
/// its lower edge, bonnet, roof, the flanks beside them; not of the wheels or of the underside, which lies below all of them.
bool lies_above(const engine::ContactRecord&, const Pose& X_WB, double off);

/// What lies outermost in each cell of the unrolled vehicle.
struct UnrolledPicture {
  enum Surface : std::uint8_t { nothing, body, glass, lamp, trim };
  static constexpr double kCell = 0.005;  // [m]
  int length = 0, width = 0;              // cells along and across
  std::vector<Surface> cells;             // row by row along, from right to left across

  Surface at(int along, int across) const;
};
UnrolledPicture unroll(const Stage&, int body, const std::vector<Point2>& tape, double length, double half_width);

/// Names for the stretches of the middle line: front, bonnet, windscreen, roof.
struct Stretch {
  const char* name;
  double from, to;  // [m] along the tape
};
std::vector<Stretch> stretches(const UnrolledPicture&, const std::vector<Point2>& tape);

}  // namespace render
