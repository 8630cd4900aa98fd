// Marks on the ground, such as skid marks: strips that OpenGL draws into a picture of what they let through.
#pragma once

#include <cstdint>
#include <vector>

#include "render/gl/frame_block.h"
#include "render/gl/object_pass.h"
#include "render/gl/program.h"
#include "render/gl/target.h"
#include "render/shade/kernels.h"

namespace render::gl {

class MarkPass {
 public:
  MarkPass();
  /// Where the list's marks lie on a picture of so many pixels.
  void begin(const DrawList&, const FrameSetup&, int width, int height);
  /// On flat ground nothing hides them but what is drawn over them.
  void draw();
  /// On a terrain: in the band r that the object pass holds, where nothing is nearer.
  void draw_on(const ObjectPass&, const Rectangle& r, int samples);
  /// Rows y0 up to y1, over what the canvas shows.
  void lay(int y0, int y1, const shade::Canvas&);

 private:
  template <class Bind>  // of what the program looks up beside the grain
  void draw_strips(const Program&, const Rectangle&, Bind);

  struct Strip {
    GLint first;
    GLsizei count;
  };
  Program flat_, on_terrain_;
  Texture noise_;
  Target target_{"picture of the marks", {GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1}, false};
  VertexArray array_;
  Buffer records_buffer_, marks_buffer_;
  int width_ = 0, height_ = 0;
  std::vector<Strip> strips_;
  Rectangle reach_;  // where they can be seen
  Rectangle read_;   // what of the picture `through_` holds
  std::vector<std::uint8_t> through_;
};

}  // namespace render::gl
