#include "render/gl/context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <cstdlib>

#include "render/error.h"
#include "render/gl/gl.h"
#include "render/late_library.h"
#include "render/renderer.h"

namespace render {
namespace {

constexpr const char* kOsMesa = "libOSMesa.so.8";
constexpr const char* kChosen = "CRASHREEL_GL";  // handed on to the processes that draw
constexpr int kSide = 16;                        // [pixels] of OSMesa's own buffer

bool egl_is_chosen() {
  const char* chosen = std::getenv(kChosen);
  return chosen && std::string(chosen) == "egl";
}

/// A function of libOSMesa by name.
template <typename Function>
void find(Function& function, const char* name) {
  function = reinterpret_cast<Function>(late_function(kOsMesa, name));
}

decltype(&::OSMesaCreateContextAttribs) create_osmesa = nullptr;
decltype(&::OSMesaMakeCurrent) make_osmesa_current = nullptr;
decltype(&::OSMesaDestroyContext) destroy_osmesa = nullptr;

}  // namespace

void choose_gl(const std::string& name) {
  setenv(kChosen, name.c_str(), 1);
}

GlContext::GlContext(Threads threads) {
  // one process a core: threads inside would only wait for each other, and none of them would be there after a fork
  if (threads == Threads::none) setenv("LP_NUM_THREADS", "0", 1);
  load_gl();
  if (on_open) on_open();
  if (egl_is_chosen())
    open_egl();
  else
    open_osmesa();
  make_current();
}

void load_gl() {
  if (egl_is_chosen()) {
#define RENDER_FIND_EGL(name) (name) = reinterpret_cast<decltype(name)>(eglGetProcAddress(#name));
    RENDER_GL_FUNCTIONS(RENDER_FIND_EGL)
    return;
  }
#define RENDER_FIND_GL(name) find(name, #name);
  RENDER_GL_FUNCTIONS(RENDER_FIND_GL)
  find(create_osmesa, "OSMesaCreateContextAttribs");
  find(make_osmesa_current, "OSMesaMakeCurrent");
  find(destroy_osmesa, "OSMesaDestroyContext");
}

void GlContext::open_osmesa() {
  const int wanted[] = {OSMESA_FORMAT,
                        OSMESA_RGBA,
                        OSMESA_PROFILE,
                        OSMESA_CORE_PROFILE,
                        OSMESA_CONTEXT_MAJOR_VERSION,
                        3,
                        OSMESA_CONTEXT_MINOR_VERSION,
                        3,
                        0};
  context_ = create_osmesa(wanted, nullptr);
  if (!context_) throw RenderError("OpenGL 3.3 core was asked of OSMesa; it gave no context: Mesa too old, or not enough memory");
  buffer_.resize(4 * kSide * kSide);
}

void GlContext::open_egl() {
  const auto refuse = [](const char* step) {
    return RenderError(fmt::format("OpenGL 3.3 core was asked of EGL, without a surface; {} failed with 0x{:x}", step,
                                   static_cast<unsigned>(eglGetError())));
  };
  display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  if (!display_ || !eglInitialize(display_, nullptr, nullptr)) throw refuse("opening the display");
  const EGLint drawable[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(display_, drawable, &config, 1, &count) || count == 0)
    throw refuse("choosing a configuration");
  const EGLint wanted[] = {
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  context_ = eglCreateContext(display_, config, nullptr, wanted);
  if (!context_) throw refuse("making the context");
}

void GlContext::make_current() const {
  const bool done =
      display_ ? eglMakeCurrent(display_, nullptr, nullptr, context_) != 0
               : make_osmesa_current(static_cast<OSMesaContext>(context_), buffer_.data(), GL_UNSIGNED_BYTE, kSide, kSide) != 0;
  if (!done) throw RenderError(fmt::format("{} made an OpenGL 3.3 context that it cannot use", display_ ? "EGL" : "OSMesa"));
}

GlContext::~GlContext() {
  if (display_)
    eglDestroyContext(display_, context_);  // other contexts use the display too
  else
    destroy_osmesa(static_cast<OSMesaContext>(context_));
}

std::string GlContext::description() const {
  const auto text = [](GLenum name) { return reinterpret_cast<const char*>(glGetString(name)); };
  return fmt::format("{}, {}, {}", display_ ? "EGL" : "OSMesa", text(GL_VERSION), text(GL_RENDERER));
}

}  // namespace render
