// GLSL text. One file of text a purpose; `kFrameBlock` stands before each. What they draw is lit by render/shade.
#pragma once

namespace render::gl {

extern const char* const kFrameBlock;
extern const char* const kTileVertex;
extern const char* const kSeenDepthFragment;
extern const char* const kStripVertex;
extern const char* const kStripFragment;

}  // namespace render::gl
