// Visibility buffer: which triangle each sample of the things' rectangle sees, by OpenGL.
#pragma once

#include <cstdint>
#include <vector>

#include "render/gl/frame_block.h"
#include "render/gl/pieces.h"
#include "render/gl/program.h"
#include "render/gl/target.h"
#include "render/gl/triangles.h"

namespace render::gl {

class ObjectPass {
 public:
  ObjectPass();
  /// The band r of a picture of `width` by `height` pixels, `samples` a side to each.
  void draw(const DrawList&, const std::vector<Piece>&, const FrameSetup&, int width, int height, int samples, const Rectangle& r);

  /// Looks into r, a part of what was drawn.
  void read(const Rectangle& r, int samples);
  /// Of what was read, row by row, lowest first: numbers of triangles, 0 where nothing is seen.
  const std::int32_t* names() const { return names_.data(); }
  Triangles& triangles() { return triangles_; }
  /// For a program that asks how near the things of the band are, and whose picture begins at x, y of the whole one: what
  /// hidden.glsl wants to know.
  void bind_depth(const Program&, int samples, int x, int y) const;

 private:
  Triangles triangles_;
  Program plain_, glass_, wires_;
  Target target_{"visibility buffer", {GL_R32I, GL_RED_INTEGER, GL_INT, 0}, true};
  Rectangle drawn_;  // [samples]
  std::vector<std::int32_t> names_;
};

}  // namespace render::gl
