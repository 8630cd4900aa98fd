// Trailers of plain build: boxes on a frame.
#pragma once

#include "assets/generate/surface.h"

namespace assets {

/// Single-axle trailer: axle at x = 0, ball coupling at x = 2.6.
Surface car_trailer();
/// Turning front axle with drawbar of a steered trailer: axle at x = 0, ball coupling at x = 1.9, turntable over the axle.
Surface dolly();
/// Body of a steered trailer: rear axle at x = 0, turntable at x = 3.0.
Surface drawbar_trailer();

std::vector<Paint> trailer_paints();

}  // namespace assets
