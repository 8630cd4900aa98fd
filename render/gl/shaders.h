// The text of the *.glsl files beside this one; CMake makes it part of the program.
#pragma once

namespace render::gl::glsl {

extern const char* const object_vert;
extern const char* const object_frag;
extern const char* const shadow_vert;
extern const char* const shadow_frag;
extern const char* const hidden;
extern const char* const mark_vert;
extern const char* const mark_frag;
extern const char* const line_vert;
extern const char* const line_frag;

}  // namespace render::gl::glsl
