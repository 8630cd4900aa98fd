// Marks on the ground, such as skid marks.
#pragma once

#include "render/gl/studio.h"

namespace render::gl {

class StripPass {
 public:
  /// Over the bare ground, before the things that stand on it; or over what is there, where its depth lets them be seen: a terrain
  /// is such a thing.
  enum class Over { ground, things };
  void draw(Studio&, const DrawList&, Over);

 private:
  Buffer vertices_;
  VertexArray array_;
};

}  // namespace render::gl
