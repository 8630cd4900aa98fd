// What vehicles roll over on.
#pragma once

#include "assets/generate/surface.h"

namespace assets {

/// A kerb to trip over: 0.15 m high, 0.3 m deep in +y from the origin, 20 m long, in short pieces.
Surface trip_curb();

/// A terrain in world axes: level ground at z = 0 that falls by 3 m between y = 0 and y = 4.5; 60 m along x, 40 m across.
Surface bank();

}  // namespace assets
