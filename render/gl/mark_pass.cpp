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
constexpr std::size_t kMarkRoom = 7, kMarkRecord = 8;

}  // namespace

MarkPass::MarkPass()
    : flat_("", glsl::mark_vert, glsl::mark_frag),
      on_terrain_(std::string("#define ON_TERRAIN\n") + glsl::hidden, glsl::mark_vert, glsl::mark_frag) {
  lay_out(array_, records_buffer_, {4, 1, 3});
  lay_out(array_, marks_buffer_, {4}, 2);
  glBindTexture(GL_TEXTURE_2D, *noise_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kNoiseSize, kNoiseSize, 0, GL_RED, GL_UNSIGNED_BYTE, grain_picture().data());
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
  for (std::vector<float>& one : places) one.resize(count + kMarkRoom);
  std::vector<float> records(kMarkRecord * (count + kMarkRoom));
  shade::Projection p{};
  const Matrix4 clip = to_gl(frame.world_to_clip);
  std::copy(clip.begin(), clip.end(), p.model_to_clip);
  p.half_width = static_cast<float>(width) / 2;
  p.half_height = static_cast<float>(height) / 2;
  shade::kernels().project(
      p, {static_cast<int>(count), places[0].data(), places[1].data(), places[2].data(), nullptr, nullptr, nullptr},
      {records.data(), nullptr});
  upload(records_buffer_, records);
  upload(marks_buffer_, marks);
  width_ = width;
  height_ = height;
  reach_ = around(records.data(), count, kMarkRecord, width, height);
  for (std::size_t i = 0; i < count; ++i)
    if (records[kMarkRecord * i + 3] != 1) reach_ = {0, 0, width, height};  // behind the eye or far aside
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
