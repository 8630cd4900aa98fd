// GLSL text. One file of text a purpose; `kFrameBlock` stands before each. What they draw is lit by render/shade.
#pragma once

namespace render::gl {

extern const char* const kFrameBlock;

}  // namespace render::gl
