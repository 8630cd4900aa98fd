#include "render/gl/mark_pass.h"

#include <algorithm>
#include <cmath>

namespace render::gl {
namespace {

using Corner = CutPoint<4>;  // rest: across, darkness, place on the ground

Corner corner_of(const StripItem& strip, std::size_t i, bool left, const Eigen::Matrix4d& world_to_clip) {
  const Float3& at = left ? strip.left[i] : strip.right[i];
  const Eigen::Vector3d p(at[0], at[1], at[2]);
  const double darkness = i < strip.darkness.size() ? static_cast<double>(strip.darkness[i]) : 0.7;
  return {world_to_clip * p.homogeneous(), {left ? -1.0 : 1.0, darkness, p.x(), p.y()}};
}

void set(const Corner& c, double width, double height, std::size_t k, shade::MarkTriangle& t) {
  const double per_w = 1 / c.clip[3];
  t.x[k] = sub_sample(c.clip[0] * per_w, width);
  t.y[k] = sub_sample(c.clip[1] * per_w, height);
  t.depth[k] = static_cast<float>(c.clip[2] * per_w * 0.5 + 0.5);
  t.per_w[k] = static_cast<float>(per_w);
  t.across[k] = static_cast<float>(c.rest[0]);
  t.darkness[k] = static_cast<float>(c.rest[1]);
  t.place_x[k] = static_cast<float>(c.rest[2]);
  t.place_y[k] = static_cast<float>(c.rest[3]);
}

}  // namespace

void MarkPass::begin(const DrawList& list, const FrameSetup& frame, int width, int height) {
  triangles_.clear();
  for (const StripItem& strip : list.strips) {
    const std::size_t n = std::min(strip.left.size(), strip.right.size());
    if (n == 0) continue;
    const auto corner = [&](std::size_t i, bool left) { return corner_of(strip, i, left, frame.world_to_clip); };
    Corner left = corner(0, true), right = corner(0, false);
    for (std::size_t i = 1; i < n; ++i) {
      const Corner next_left = corner(i, true), next_right = corner(i, false);
      add({left, right, next_right}, width, height);
      add({left, next_right, next_left}, width, height);
      left = next_left;
      right = next_right;
    }
  }
}

void MarkPass::add(const std::array<CutPoint<4>, 3>& c, double width, double height) {
  const auto put = [&](const Corner& p, const Corner& q, const Corner& r) {
    shade::MarkTriangle t{};
    set(p, width, height, 0, t);
    set(q, width, height, 1, t);
    set(r, width, height, 2, t);
    const std::int64_t x1 = t.x[1] - t.x[0], y1 = t.y[1] - t.y[0], x2 = t.x[2] - t.x[0], y2 = t.y[2] - t.y[0];
    if (x1 * y2 < x2 * y1) {  // seen from the other side
      set(r, width, height, 1, t);
      set(q, width, height, 2, t);
    }
    triangles_.push_back(t);
  };
  // within twice the picture nothing needs to be cut
  const auto within = [](const Corner& p) {
    const double end = 2 * p.clip[3];
    return p.clip[3] > 0.01 && p.clip[2] > -p.clip[3] && std::abs(p.clip[0]) < end && std::abs(p.clip[1]) < end;
  };
  if (std::all_of(c.begin(), c.end(), within)) return put(c[0], c[1], c[2]);
  const CutPolygon<4> seen = cut_to_grid(CutPolygon<4>(c.begin(), c.end()), width, height);
  for (std::size_t i = 2; i < seen.size(); ++i) put(seen[0], seen[i - 1], seen[i]);
}

void MarkPass::draw(int y0, int y1, const float* depth, const shade::Maps& maps, const shade::Canvas& canvas) const {
  if (triangles_.empty() || y0 >= y1) return;
  shade::kernels().marks(maps, {triangles_.data(), static_cast<int>(triangles_.size()), y0, y1, depth}, canvas);
}

}  // namespace render::gl
