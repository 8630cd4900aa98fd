// Bodies like boxes - van, bus, cab, load box - as a pile of outlines in plan: each a rounded rectangle between a front, a rear and
// a side line drawn over the height, with a rounded edge round the roof.
#pragma once

#include "assets/generate/curve.h"
#include "assets/generate/surface.h"

namespace assets {

struct Coach {
  Curve front, rear, half;           // [m] x, x and y over the height
  double bottom = 0, top = 0;        // [m]
  double corner_front, corner_rear;  // [m] radii in plan
  double roof = 0.1;                 // [m] radius of the roof's edge
  double bow = 0;                    // [m] how far the middle of the front stands out
};

struct Fineness {
  int levels = 60, arc = 8, side = 80, flat = 14;
};

/// Half of the skin, y >= 0, of one material, closed by roof and floor.
Surface half_coach(const Coach&, const std::string& material, const Fineness& = {});

}  // namespace assets
