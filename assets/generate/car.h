// A passenger car as curves along its length; sections between them are cubic B-splines.
#pragma once

#include "assets/generate/surface.h"

namespace assets {

/// Visual bodywork: windows, lamps, seams and wheel arches cut in, interior inside. Origin on the ground, middle of the wheelbase.
Surface bodywork();
/// Closed outer shell for contact, same frame.
Surface shell();

/// A kerb to trip over: 0.15 m high, 0.3 m deep in +y from the origin, 20 m long, in short pieces.
Surface trip_curb();

std::vector<Paint> car_paints();

}  // namespace assets
