#include "render/gl/studio.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

#include "render/gl/noise.h"
#include "render/gl/pieces.h"
#include "render/gl/shaders.h"

namespace render {
namespace {

constexpr int kWidestFine = 4096;  // [pixels] four times that is the largest texture

}  // namespace

Effort effort_of(Quality q, int width, int height) {
  if (q == Quality::draft) return {1, 1, 512, 1, 0.05, 128, 0.5, 2};
  if (q == Quality::standard) return {1, 2, 1024, 1, 0.05, 128, 0.2};
  return {std::max(width, height) > kWidestFine ? 1 : 2, 2, 2048, 2, 0.10, 256, 0.2};
}

}  // namespace render

namespace render::gl {
namespace {

constexpr GLsizeiptr kSharedBytes = offsetof(FrameBlock, world_to_shadow);  // what the shaders know of it

}  // namespace

Studio::Studio(int w, int h) : targets(w, h) {
  const std::vector<std::uint8_t> grain = grain_picture();
  glBindTexture(GL_TEXTURE_2D, *noise_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kNoiseSize, kNoiseSize, 0, GL_RED, GL_UNSIGNED_BYTE, grain.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glBindBuffer(GL_UNIFORM_BUFFER, *block_);
  glBufferData(GL_UNIFORM_BUFFER, kSharedBytes, nullptr, GL_DYNAMIC_DRAW);
}

const Program& Studio::program(const Variant& v) {
  std::unique_ptr<Program>& p = programs_[v];
  if (!p) {
    p = std::make_unique<Program>("", std::string(kFrameBlock) + v.vertex, std::string(kFrameBlock) + v.fragment);
  }
  p->use();
  return *p;
}

void Studio::bind_inputs(const FrameSetup& frame) {
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, *block_);
  glBufferSubData(GL_UNIFORM_BUFFER, 0, kSharedBytes, &frame.block);
  // in the order of kSamplers
  const GLuint textures[] = {*noise_, *targets.seen_depth};
  static_assert(std::size(textures) == std::size(kSamplers));
  for (GLuint unit = 0; unit < std::size(textures); ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, textures[unit]);
  }
  glActiveTexture(GL_TEXTURE0 + std::size(textures));  // an upload disturbs none of them
}

void Studio::fill(const std::vector<Rectangle>& rectangles) {
  std::vector<float> corners;
  for (const Rectangle& r : rectangles) {
    if (r.width <= 0 || r.height <= 0) continue;
    const float x0 = static_cast<float>(r.x), y0 = static_cast<float>(r.y);
    const float x1 = static_cast<float>(r.x + r.width), y1 = static_cast<float>(r.y + r.height);
    corners.insert(corners.end(), {x0, y0, x1, y0, x1, y1, x0, y0, x1, y1, x0, y1});
  }
  if (corners.empty()) return;
  glBindVertexArray(*corners_array_);
  glBindBuffer(GL_ARRAY_BUFFER, *corners_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(float)), corners.data(), GL_STREAM_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 2 * sizeof(float), nullptr);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners.size() / 2));
}

}  // namespace render::gl
