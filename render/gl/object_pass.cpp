#include "render/gl/object_pass.h"

#include <algorithm>

namespace render::gl {

void ObjectPass::draw(const DrawList& list, const std::vector<Piece>& pieces, const FrameSetup& frame, int width, int height,
                      int samples, const Rectangle& r) {
  constexpr std::size_t kRoom = 7;
  const std::size_t count = static_cast<std::size_t>(r.width * samples) * static_cast<std::size_t>(r.height * samples);
  if (names_.size() < count + kRoom) names_.resize(count + kRoom);
  if (depth_.size() < count + kRoom) depth_.resize(count + kRoom);
  std::fill_n(depth_.begin(), count, 1.0f);
  sampler_.clear();
  // seen from above, the ground hides what has sunk into it; a terrain does so by its own depth
  const float ground = static_cast<float>(list.road.height);
  const bool above = list.view.eye[2] > ground && !list.road.terrain;
  sampler_.draw(
      {frame.world_to_clip, static_cast<double>(width * samples), static_cast<double>(height * samples), ground, above}, pieces,
      {depth_.data(), names_.data(), r.width * samples, r.x * samples, r.y * samples, r.width * samples, r.height * samples});
}

void ObjectPass::cover(const Rectangle& r, int samples, int width, std::vector<std::uint8_t>& out) const {
  const std::ptrdiff_t w = r.width * samples;
  for (int y = 0; y < r.height; ++y) {
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(r.y + y) * width;
    std::fill_n(out.begin() + row, width, std::uint8_t{0});
    const float* low = depth() + static_cast<std::ptrdiff_t>(y * samples) * w;
    std::uint8_t* to = out.data() + row + r.x;
    if (samples == 1)
      for (int x = 0; x < r.width; ++x) to[x] = low[x] < 1 ? 255 : 0;
    else
      for (int x = 0; x < r.width; ++x, low += 2)
        to[x] = std::max(std::max(low[0], low[1]), std::max(low[w], low[w + 1])) < 1 ? 255 : 0;
  }
}

}  // namespace render::gl
