// GLSL sources. Plain strings, so that the program needs no files at run time.
#pragma once

namespace render::shaders {

extern const char* const kCommon;  // light, sky, shadow, tone mapping: prefixed to the two below
extern const char* const kObjectVertex;
extern const char* const kObjectFragment;
extern const char* const kShadowVertex;
extern const char* const kShadowFragment;
extern const char* const kBackgroundVertex;
extern const char* const kBackgroundFragment;
extern const char* const kOverlayVertex;
extern const char* const kOverlayFragment;

}  // namespace render::shaders
