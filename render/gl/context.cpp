#include "render/gl/context.h"

#include <cstdlib>

#include "render/error.h"
#include "render/gl/gl.h"

namespace render {

GlContext::GlContext(int width, int height, Threads threads)
    : width_(width), height_(height), buffer_(static_cast<std::size_t>(4 * width * height)) {
  // one process a core: threads inside would only wait for each other, and none of them would be there after a fork
  if (threads == Threads::none) setenv("LP_NUM_THREADS", "0", 1);
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
  if (!context)
    throw RenderError(
        "OSMesa gives no OpenGL 3.3 core context: none at all, or an older one. libosmesa6 of Mesa 12 or later is wanted");
  context_ = context;
  make_current();
}

void GlContext::make_current() const {
  if (!OSMesaMakeCurrent(static_cast<OSMesaContext>(context_), buffer_.data(), GL_UNSIGNED_BYTE, width_, height_))
    throw RenderError("OSMesa gives an OpenGL 3.3 context but cannot make it current with a buffer of " + std::to_string(width_) +
                      " x " + std::to_string(height_) + " pixels");
}

GlContext::~GlContext() {
  if (context_) OSMesaDestroyContext(static_cast<OSMesaContext>(context_));
}

std::string GlContext::description() const {
  return "OSMesa, " + std::string(reinterpret_cast<const char*>(glGetString(GL_VERSION))) + ", " +
         reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

}  // namespace render
