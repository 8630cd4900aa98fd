// Things: what each sample sees of them, then their light onto the picture.
#pragma once

#include <vector>

#include "render/gl/pieces.h"
#include "render/gl/studio.h"

namespace render::gl {

/// What each sample in the band r of the picture sees.
void draw_objects(Studio&, const DrawList&, const std::vector<Piece>&, const Rectangle& r);

/// Their light, onto the picture; with their depth if a line may pass behind them.
void light_objects(Studio&, const DrawList&, const Rectangle& r, bool depth);

}  // namespace render::gl
