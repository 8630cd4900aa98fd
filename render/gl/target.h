// Textures that are drawn into.
#pragma once

#include "render/gl/names.h"

namespace render::gl {

struct TexelFormat {
  GLenum internal, format, type;
};

/// Gives the texture this size and hangs it into the bound framebuffer.
void attach(const Texture&, GLenum attachment, const TexelFormat&, int width, int height);
/// Throws RenderError if OpenGL refuses the bound framebuffer; says what was asked for.
void check_target(const char* name, int width, int height);

}  // namespace render::gl
