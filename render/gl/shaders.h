// GLSL text. One file of text a purpose; `kCommon` (frame block, light, sky, shadow, tone curve) stands before each fragment
// shader.
#pragma once

namespace render::gl {

extern const char* const kFrameBlock;
extern const char* const kCommon;
extern const char* const kTileVertex;
extern const char* const kSkyFragment;
extern const char* const kOcclusionFragment;
extern const char* const kGroundFragment;
extern const char* const kGroundPattern;
extern const char* const kObjectVertex;
extern const char* const kObjectFragment;
extern const char* const kSeenDepthFragment;
extern const char* const kSurfaces;  // before the next two
extern const char* const kCountFragment;
extern const char* const kShadeFragment;
extern const char* const kDepthVertex;
extern const char* const kDepthFragment;
extern const char* const kStripVertex;
extern const char* const kStripFragment;
extern const char* const kCopyVertex;
extern const char* const kOverlayVertex;
extern const char* const kOverlayFragment;

}  // namespace render::gl
