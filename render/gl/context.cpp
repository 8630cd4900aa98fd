#include "render/gl/context.h"

#include "render/error.h"
#include "render/gl/gl.h"

namespace render {

GlContext::GlContext(int width, int height)
    : width_(width), height_(height), buffer_(static_cast<std::size_t>(4 * width * height)) {
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            24,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            0};
  const OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (!context) throw RenderError("cannot create an off-screen OpenGL 3.3 context: is libosmesa6 installed?");
  context_ = context;
  make_current();
}

void GlContext::make_current() const {
  if (!OSMesaMakeCurrent(static_cast<OSMesaContext>(context_), buffer_.data(), GL_UNSIGNED_BYTE, width_, height_))
    throw RenderError("cannot make the off-screen OpenGL context current");
}

GlContext::~GlContext() {
  if (context_) OSMesaDestroyContext(static_cast<OSMesaContext>(context_));
}

std::string GlContext::description() const {
  return std::string(reinterpret_cast<const char*>(glGetString(GL_VERSION))) + ", " +
         reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

}  // namespace render
