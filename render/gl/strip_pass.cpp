#include "render/gl/strip_pass.h"

#include <algorithm>
#include <vector>

#include "render/gl/shaders.h"

namespace render::gl {
namespace {

constexpr int kFloats = 6;  // per vertex: place 3, across, darkness, along

std::vector<float> triangles_of(const std::vector<StripItem>& strips) {
  std::vector<float> data;
  for (const StripItem& strip : strips) {
    const std::size_t n = std::min(strip.left.size(), strip.right.size());
    const auto put = [&](std::size_t i, bool left) {
      const Float3& p = left ? strip.left[i] : strip.right[i];
      data.insert(data.end(), {p[0], p[1], p[2], left ? -1.0f : 1.0f, i < strip.darkness.size() ? strip.darkness[i] : 0.7f, 0.0f});
    };
    for (std::size_t i = 0; i + 1 < n; ++i) {
      put(i, true), put(i, false), put(i + 1, false);
      put(i, true), put(i + 1, false), put(i + 1, true);
    }
  }
  return data;
}

}  // namespace

void StripPass::draw(Studio& studio, const DrawList& list, Over over) {
  const std::vector<float> data = triangles_of(list.strips);
  if (data.empty()) return;
  glBindFramebuffer(GL_FRAMEBUFFER, *studio.targets.picture);
  glViewport(0, 0, studio.targets.width, studio.targets.height);
  glDisable(GL_SCISSOR_TEST);
  if (over == Over::things) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1, -2);  // the depth they are held against is the nearest in a pixel
  } else {
    glDisable(GL_DEPTH_TEST);
  }
  studio.program({kStripVertex, kStripFragment});
  glBindVertexArray(*array_);
  glBindBuffer(GL_ARRAY_BUFFER, *vertices_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(float)), data.data(), GL_STREAM_DRAW);
  for (GLuint i = 0; i < 2; ++i) {
    glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, kFloats * sizeof(float),
                          reinterpret_cast<const void*>(std::size_t{i} * 3 * sizeof(float)));
  }
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(data.size() / kFloats));
  glDisable(GL_BLEND);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDepthMask(GL_TRUE);
}

}  // namespace render::gl
