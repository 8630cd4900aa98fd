// GLSL text. One file of text a purpose; `kFrameBlock` stands before each. What they draw is lit by render/shade.
#pragma once

namespace render::gl {

extern const char* const kFrameBlock;
extern const char* const kTileVertex;
extern const char* const kObjectVertex;
extern const char* const kObjectFragment;
extern const char* const kSeenDepthFragment;
extern const char* const kDepthVertex;
extern const char* const kDepthFragment;
extern const char* const kStripVertex;
extern const char* const kStripFragment;
extern const char* const kOverlayVertex;
extern const char* const kOverlayFragment;

}  // namespace render::gl
