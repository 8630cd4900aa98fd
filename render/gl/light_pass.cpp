#include "render/gl/light_pass.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

#include "render/gl/shaders.h"

namespace render::gl {
namespace {

constexpr int kAlike = 4588;  // of 65535: normals within some 15 degrees
constexpr float kPer16 = 1.0f / 65535.0f;

/// One surface: the same material, normals close to each other. At the octahedron's folds a surface may look like two; that costs
/// time alone.
bool alike(const std::uint16_t* a, const std::uint16_t* b) {
  return a[2] == b[2] && std::abs(a[0] - b[0]) < kAlike && std::abs(a[1] - b[1]) < kAlike;
}

}  // namespace

void LightPass::draw(Studio& studio, const Lighting& lighting, const Rectangle& r, bool depth) {
  if (r.width <= 0 || r.height <= 0) return;
  read(studio.targets, r);
  for (auto* list : {&share_, &x_, &y_, &z_, &u_, &v_, &grain_}) list->clear();
  pixel_.clear();
  row_.clear();
  find_surfaces(r, studio.targets.samples);
  light(lighting);
  glViewport(0, 0, studio.targets.width, studio.targets.height);
  glBindFramebuffer(GL_FRAMEBUFFER, *studio.targets.picture);
  if (depth) {
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_ALWAYS);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    const Program& p = studio.program({kTileVertex, kSeenDepthFragment});
    p.set("origin", static_cast<float>(r.x), static_cast<float>(r.y));
    studio.fill({r});
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthFunc(GL_LEQUAL);
  }
  glDisable(GL_DEPTH_TEST);
  lay(studio.targets, r);
}

void LightPass::read(const Targets& targets, const Rectangle& r) {
  const int w = r.width * targets.samples, h = r.height * targets.samples;
  const std::size_t count = static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
  seen_.resize(4 * count);
  depth_.resize(count);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, *targets.seen);
  glReadPixels(0, 0, w, h, GL_RGBA, GL_UNSIGNED_SHORT, seen_.data());
  glReadPixels(0, 0, w, h, GL_DEPTH_COMPONENT, GL_FLOAT, depth_.data());
}

void LightPass::find_surfaces(const Rectangle& r, int samples) {
  const int w = r.width * samples;
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x) {
      const float* low =
          &depth_[static_cast<std::size_t>(y * samples) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x * samples)];
      bool empty = low[0] >= 1;
      if (samples == 2) empty = empty && low[1] >= 1 && low[w] >= 1 && low[w + 1] >= 1;
      if (!empty) add_pixel(r, x, y, samples);
    }
}

/// The samples of a pixel show one surface, or two: nearly no pixel shows three, and the third then looks like the second.
void LightPass::add_pixel(const Rectangle& r, int x, int y, int samples) {
  const std::size_t w = static_cast<std::size_t>(r.width * samples);
  const std::size_t corner = static_cast<std::size_t>(y * samples) * w + static_cast<std::size_t>(x * samples);
  const std::array<std::size_t, 4> at{corner, corner + 1, corner + w, corner + w + 1};
  const int all = samples * samples;
  unsigned left = 0;
  for (int k = 0; k < all; ++k) left |= depth_[at[static_cast<std::size_t>(k)]] < 1 ? 1u << k : 0u;
  for (int surface = 0; surface < 2 && left != 0; ++surface) {
    int first = 0;
    while (!(left >> first & 1)) ++first;
    const std::uint16_t* a = &seen_[4 * at[static_cast<std::size_t>(first)]];
    unsigned same = 0;
    int u = 0, v = 0, grain = 0, right = 0, up = 0, n = 0;
    float z = 0;
    for (int k = first; k < all; ++k) {
      const std::uint16_t* b = &seen_[4 * at[static_cast<std::size_t>(k)]];
      if (!(left >> k & 1) || !alike(a, b)) continue;
      same |= 1u << k;
      ++n;
      u += b[0];
      v += b[1];
      grain += b[3];
      z += depth_[at[static_cast<std::size_t>(k)]];
      right += k & 1;
      up += k >> 1;
    }
    const float per = 1.0f / static_cast<float>(n), sample = 1.0f / static_cast<float>(samples);
    pixel_.push_back(y * r.width + x);
    const int covered = surface == 0 ? n : std::popcount(left);
    share_.push_back(static_cast<float>(covered) / static_cast<float>(all));
    x_.push_back(static_cast<float>(r.x + x) + sample * (0.5f + static_cast<float>(right) * per));
    y_.push_back(static_cast<float>(r.y + y) + sample * (0.5f + static_cast<float>(up) * per));
    z_.push_back(z * per);
    u_.push_back(static_cast<float>(u) * per * kPer16);
    v_.push_back(static_cast<float>(v) * per * kPer16);
    grain_.push_back(static_cast<float>(grain) * per * kPer16);
    row_.push_back(a[2] - 1);
    left &= ~same;
  }
}

void LightPass::light(const Lighting& lighting) {
  const std::size_t count = pixel_.size(), room = count + 7;
  for (auto* list : {&x_, &y_, &z_, &u_, &v_, &grain_, &red_, &green_, &blue_}) list->resize(room, 0.5f);
  row_.resize(room, 0);
  shade::kernels().surfaces(lighting.data, lighting.maps, lighting.materials, lighting.terrain,
                            {static_cast<int>(count), x_.data(), y_.data(), z_.data(), u_.data(), v_.data(), grain_.data(),
                             row_.data(), red_.data(), green_.data(), blue_.data()});
}

void LightPass::lay(const Targets& targets, const Rectangle& r) {
  picture_.resize(4 * static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height));
  glReadPixels(r.x, r.y, r.width, r.height, GL_RGBA, GL_UNSIGNED_BYTE, picture_.data());
  for (std::size_t i = 0; i < pixel_.size();) {
    const int pixel = pixel_[i];
    std::uint8_t* out = &picture_[4 * static_cast<std::size_t>(pixel)];
    float left = 1;
    std::array<float, 3> sum{};
    for (; i < pixel_.size() && pixel_[i] == pixel; ++i) {
      const std::array<float, 3> c{red_[i], green_[i], blue_[i]};
      for (std::size_t k = 0; k < 3; ++k) sum[k] += share_[i] * 255 * std::clamp(c[k], 0.0f, 1.0f);
      left -= share_[i];
    }
    for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<std::uint8_t>(sum[k] + left * static_cast<float>(out[k]) + 0.5f);
  }
  glBindTexture(GL_TEXTURE_2D, *targets.picture_colour);
  glTexSubImage2D(GL_TEXTURE_2D, 0, r.x, r.y, r.width, r.height, GL_RGBA, GL_UNSIGNED_BYTE, picture_.data());
}

}  // namespace render::gl
