#include "render/gl/mark_pass.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/gl/noise.h"
#include "render/gl/shaders.h"
#include "render/matrix.h"

namespace render::gl {
namespace {

constexpr int kRubber = 41;  // of 4 x 255: 0.012 on the tone curve
constexpr std::size_t kRoom = 7, kRecord = 8, kMark = 4;

void attribute(GLuint i, int size, std::size_t stride, std::size_t offset) {
  glEnableVertexAttribArray(i);
  glVertexAttribPointer(i, size, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride * sizeof(float)),
                        reinterpret_cast<const void*>(offset * sizeof(float)));
}

/// Where corners lie, and what lies between them; the whole picture if one lies behind the eye or far aside.
Rectangle reach_of(const std::vector<float>& records, std::size_t count, int width, int height) {
  float x0 = 1e9f, x1 = -1e9f, y0 = 1e9f, y1 = -1e9f;
  for (const float* r = records.data(); r < records.data() + kRecord * count; r += kRecord) {
    if (r[3] != 1) return {0, 0, width, height};
    x0 = std::min(x0, r[0]);
    x1 = std::max(x1, r[0]);
    y0 = std::min(y0, r[1]);
    y1 = std::max(y1, r[1]);
  }
  const int x = static_cast<int>(std::floor(x0)), y = static_cast<int>(std::floor(y0));
  return both({x, y, static_cast<int>(x1) + 1 - x, static_cast<int>(y1) + 1 - y}, {0, 0, width, height});
}

}  // namespace

MarkPass::MarkPass()
    : flat_("", glsl::mark_vert, glsl::mark_frag),
      on_terrain_(std::string("#define ON_TERRAIN\n") + glsl::nearest, glsl::mark_vert, glsl::mark_frag) {
  glBindVertexArray(*array_);
  glBindBuffer(GL_ARRAY_BUFFER, *records_buffer_);
  attribute(0, 4, kRecord, 0);
  attribute(1, 1, kRecord, 4);
  glBindBuffer(GL_ARRAY_BUFFER, *marks_buffer_);
  attribute(2, 4, kMark, 0);
  const std::vector<std::uint8_t> grain = grain_picture();
  glBindTexture(GL_TEXTURE_2D, *noise_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kNoiseSize, kNoiseSize, 0, GL_RED, GL_UNSIGNED_BYTE, grain.data());
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
}

void MarkPass::begin(const DrawList& list, const FrameSetup& frame, int width, int height) {
  strips_.clear();
  read_ = {};
  std::array<std::vector<float>, 3> places;
  std::vector<float> marks;
  for (const StripItem& strip : list.strips) {
    const std::size_t n = std::min(strip.left.size(), strip.right.size());
    if (n < 2) continue;
    strips_.push_back({static_cast<GLint>(places[0].size()), static_cast<GLsizei>(2 * n)});
    for (std::size_t i = 0; i < n; ++i)
      for (const bool left : {false, true}) {
        const Float3& p = left ? strip.left[i] : strip.right[i];
        for (std::size_t k = 0; k < 3; ++k) places[k].push_back(p[k]);
        marks.insert(marks.end(), {left ? -1.0f : 1.0f, i < strip.darkness.size() ? strip.darkness[i] : 0.7f, p[0], p[1]});
      }
  }
  if (strips_.empty()) return;
  const std::size_t count = places[0].size();
  for (std::vector<float>& one : places) one.resize(count + kRoom);
  std::vector<float> records(kRecord * (count + kRoom));
  shade::Projection p{};
  const Matrix4 clip = to_gl(frame.world_to_clip);
  std::copy(clip.begin(), clip.end(), p.model_to_clip);
  p.half_width = static_cast<float>(width) / 2;
  p.half_height = static_cast<float>(height) / 2;
  shade::kernels().project(
      p, {static_cast<int>(count), places[0].data(), places[1].data(), places[2].data(), nullptr, nullptr, nullptr},
      {records.data(), nullptr});
  const auto put = [](const Buffer& buffer, const std::vector<float>& numbers) {
    glBindBuffer(GL_ARRAY_BUFFER, *buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(numbers.size() * sizeof(float)), numbers.data(), GL_STREAM_DRAW);
  };
  put(records_buffer_, records);
  put(marks_buffer_, marks);
  width_ = width;
  height_ = height;
  reach_ = reach_of(records, count, width, height);
}

/// Part of what lies under them: one is nothing, and each mark takes its share of what the others let through.
template <class Bind>
void MarkPass::draw_strips(const Program& program, const Rectangle& r, Bind bind) {
  read_ = both(reach_, r);
  if (strips_.empty() || read_.width == 0 || read_.height == 0) return;
  target_.begin(reach_, width_, height_);
  target_.confine(read_);
  bind();
  program.use();
  program.set("per_viewport", target_.per_viewport());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, *noise_);
  glBindVertexArray(*array_);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ZERO, GL_ONE_MINUS_SRC_COLOR);
  for (const Strip& strip : strips_) glDrawArrays(GL_TRIANGLE_STRIP, strip.first, strip.count);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  through_.resize(static_cast<std::size_t>(read_.width) * static_cast<std::size_t>(read_.height));
  target_.read(read_, through_.data());
}

void MarkPass::draw() {
  draw_strips(flat_, reach_, [] {});
}

void MarkPass::draw_on(const ObjectPass& objects, const Rectangle& r, int samples) {
  draw_strips(on_terrain_, r, [&] { objects.bind_depth(on_terrain_, samples, reach_.x, reach_.y); });
}

void MarkPass::lay(int y0, int y1, const shade::Canvas& canvas) {
  for (int y = std::max(y0, read_.y); y < std::min(y1, read_.y + read_.height); ++y) {
    const std::uint8_t* through = through_.data() + static_cast<std::ptrdiff_t>(y - read_.y) * read_.width;
    std::uint8_t* to = canvas.pixels + 4 * (y * canvas.pitch + read_.x);
    for (int x = 0; x < read_.width; ++x, to += 4) {
      if (through[x] == 255) continue;
      for (int c = 0; c < 3; ++c)
        to[c] = static_cast<std::uint8_t>((4 * to[c] * through[x] + kRubber * (255 - through[x]) + 510) / 1020);
    }
  }
}

}  // namespace render::gl
