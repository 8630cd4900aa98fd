// Things: what each sample sees of them.
#pragma once

#include <vector>

#include "render/gl/pieces.h"
#include "render/gl/studio.h"

namespace render::gl {

/// What each sample in the band r of the picture sees.
void draw_objects(Studio&, const DrawList&, const std::vector<Piece>&, const Rectangle& r);

}  // namespace render::gl
