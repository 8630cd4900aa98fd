// An off-screen OpenGL 3.3 core context, current in the process that made it. Made after a fork, never carried over one. Two back
// ends: OSMesa, and EGL without a surface (for graphics cards, and for Mesa from 25.1 on, which has no OSMesa).
#pragma once

#include <string>
#include <vector>

namespace render {

/// Finds the functions of the back end that choose_gl named. A context does so itself; done before a fork, its children share what
/// was loaded. Throws RenderError.
void load_gl();

class GlContext {
 public:
  enum class Threads { none, own };  // of llvmpipe, beside the caller's
  /// The back end that choose_gl named. Throws RenderError: no context, or too old a one.
  explicit GlContext(Threads = Threads::none);
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  void make_current() const;  // throws RenderError
  /// Called as a process makes a context, unless null. Set by the program.
  static inline void (*on_open)() = nullptr;
  std::string description() const;

 private:
  void open_osmesa();
  void open_egl();

  void* context_ = nullptr;
  void* display_ = nullptr;                    // of EGL; null: OSMesa
  mutable std::vector<unsigned char> buffer_;  // OSMesa wants one to be current; pictures are read from our own framebuffer
};

}  // namespace render
