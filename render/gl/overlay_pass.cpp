#include "render/gl/overlay_pass.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "render/matrix.h"

namespace render::gl {
namespace {

constexpr float kNear = 0.05f;  // clip w below which a point is behind the camera
const Float4 kOutline{0.05f, 0.05f, 0.06f, 0.85f};

/// Narrows x0 .. x1 to where low <= value + x slope <= high.
void narrow(float value, float slope, float low, float high, float& x0, float& x1) {
  if (std::abs(slope) < 1e-6f) {
    if (value < low || value > high) x1 = x0;
    return;
  }
  const float a = (low - value) / slope, b = (high - value) / slope;
  x0 = std::max(x0, std::min(a, b));
  x1 = std::min(x1, std::max(a, b));
}

}  // namespace

void OverlayPass::begin(const DrawList& list, const shade::Canvas& canvas) {
  const Mat4 m = from_gl(list.view.eye_to_clip) * from_gl(list.view.world_to_eye);
  for (std::size_t i = 0; i < 16; ++i) clip_[i] = static_cast<float>(m.data()[i]);
  canvas_ = canvas;
  width_ = static_cast<float>(canvas.width);
  height_ = static_cast<float>(canvas.height);
  scale_ = height_ / 1080 * list.scale;
}

bool OverlayPass::project(const Float3& a, const Float3& b, Pixel& pa, Pixel& pb) const {
  auto clip = [&](const Float3& p) {
    Float4 c{};
    for (std::size_t r = 0; r < 4; ++r) c[r] = clip_[r] * p[0] + clip_[4 + r] * p[1] + clip_[8 + r] * p[2] + clip_[12 + r];
    return c;
  };
  Float4 ca = clip(a), cb = clip(b);
  if (ca[3] < kNear && cb[3] < kNear) return false;
  auto cut = [](Float4& behind, const Float4& front) {
    const float s = (kNear - behind[3]) / (front[3] - behind[3]);
    for (std::size_t i = 0; i < 4; ++i) behind[i] += s * (front[i] - behind[i]);
  };
  if (ca[3] < kNear) cut(ca, cb);
  if (cb[3] < kNear) cut(cb, ca);
  auto pixel = [&](const Float4& c) {
    return Pixel{(c[0] / c[3] * 0.5f + 0.5f) * width_, (c[1] / c[3] * 0.5f + 0.5f) * height_, c[2] / c[3] * 0.5f + 0.5f};
  };
  pa = pixel(ca);
  pb = pixel(cb);
  return true;
}

/// Depth is linear over the picture of a plane: its slopes from two points beside the one at hand.
void OverlayPass::lie_on(const Float3& at, const Float3& normal, Pixel& pixel) const {
  const Eigen::Vector3f n(normal[0], normal[1], normal[2]);
  const Eigen::Vector3f u = n.unitOrthogonal(), v = n.cross(u);
  const auto beside = [&](const Eigen::Vector3f& d) {
    constexpr float kAside = 0.1f;  // [m]
    return Float3{at[0] + kAside * d.x(), at[1] + kAside * d.y(), at[2] + kAside * d.z()};
  };
  Pixel here{}, p{}, q{};
  if (!project(at, beside(u), here, p) || !project(at, beside(v), here, q)) return;
  const float px = p.x - here.x, py = p.y - here.y, pz = p.z - here.z, qx = q.x - here.x, qy = q.y - here.y, qz = q.z - here.z;
  const float area = px * qy - qx * py;
  if (std::abs(area) < 1e-3f * (px * px + py * py + qx * qx + qy * qy)) return;  // seen from its edge
  pixel.slope_x = (pz * qy - qz * py) / area;
  pixel.slope_y = (qz * px - pz * qx) / area;
}

/// Distance to a capsule, or to a taper cut square, tells how much of a pixel is covered.
void OverlayPass::capsule(const Pixel& a, const Pixel& b, float half_a, float half_b, const Float4& colour, Ends ends) const {
  const float length = std::hypot(b.x - a.x, b.y - a.y);
  const bool point = length <= 1e-4f, square = ends == Ends::square;
  const float dx = point ? 1 : (b.x - a.x) / length, dy = point ? 0 : (b.y - a.y) / length;
  const float pad = 1, wide = std::max(half_a, half_b) + pad, before = square ? pad : wide;
  const auto row_of = [this](float y) { return static_cast<int>(std::clamp(y, 0.0f, height_)); };
  const float reach = std::max(wide, before);
  for (int row = row_of(std::min(a.y, b.y) - reach); row < row_of(std::max(a.y, b.y) + reach + 1); ++row) {
    const float y = static_cast<float>(row) + 0.5f - a.y;
    float x0 = 0, x1 = width_;
    const float along_0 = (0.5f - a.x) * dx + y * dy, across_0 = y * dx - (0.5f - a.x) * dy;
    narrow(across_0, -dy, -wide, wide, x0, x1);
    narrow(along_0, dx, -before, length + before, x0, x1);
    const int last = static_cast<int>(std::min(std::ceil(x1) + 1, width_));
    for (int x = static_cast<int>(std::max(x0, 0.0f)); x < last; ++x) {
      const float along = along_0 + static_cast<float>(x) * dx, across = across_0 - static_cast<float>(x) * dy;
      const float beyond = std::max(-along, along - length), share = point ? 0 : along / length;
      const float half = half_a + (half_b - half_a) * share;
      const float d = square ? std::max(std::abs(across) - half, beyond)
                             : std::sqrt(across * across + std::max(beyond, 0.0f) * std::max(beyond, 0.0f)) - half_a;
      const float cover = std::clamp(0.5f - d, 0.0f, 1.0f);
      if (cover <= 0) continue;
      if (depth_) {
        const float s = std::clamp(share, 0.0f, 1.0f), off_along = along - s * length;
        const float off_x = dx * off_along - dy * across, off_y = dy * off_along + dx * across;
        const float z = a.z + (b.z - a.z) * s + (a.slope_x + (b.slope_x - a.slope_x) * s) * off_x +
                        (a.slope_y + (b.slope_y - a.slope_y) * s) * off_y;
        if (std::clamp(z, 0.0f, 1.0f) > depth_[static_cast<std::ptrdiff_t>(row) * canvas_.width + x]) continue;
      }
      std::uint8_t* const out = canvas_.pixels + 4 * (row * canvas_.pitch + x);
      const float alpha = colour[3] * cover;
      for (std::size_t c = 0; c < 3; ++c)
        out[c] = static_cast<std::uint8_t>(255 * colour[c] * alpha + static_cast<float>(out[c]) * (1 - alpha) + 0.5f);
    }
  }
}

void OverlayPass::polyline(const LineItem& line, float extra, const Float4& colour) const {
  const float half = 0.5f * line.width * scale_ + extra * scale_;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    Pixel a{}, b{};
    if (!project(line.points[i - 1], line.points[i], a, b)) continue;
    if (line.normals.size() == line.points.size()) {
      lie_on(line.points[i - 1], line.normals[i - 1], a);
      lie_on(line.points[i], line.normals[i], b);
    }
    capsule(a, b, half, half, colour);
  }
}

void OverlayPass::arrow(const ArrowItem& item, float extra, const Float4& colour) const {
  Pixel a{}, b{};
  if (!project(item.from, item.to, a, b)) return;
  const float half = 0.5f * item.width * scale_, edge = extra * scale_;
  const float length = std::hypot(b.x - a.x, b.y - a.y);
  if (length < 2 * half) return;  // seen from its end: the marker tells of it
  const float head = std::min(6.0f * half, 0.75f * length), wide = 0.42f * head;
  auto on = [&](float pixels) {
    const float s = pixels / length;
    return Pixel{a.x + (b.x - a.x) * s, a.y + (b.y - a.y) * s, a.z + (b.z - a.z) * s};
  };
  capsule(a, on(length - head), half + edge, half + edge, colour);
  // the outline of a wedge as far from its sides as from its base: its tip moves on by more than that
  const float slope = wide / head, ahead = edge * std::sqrt(1 + slope * slope) / slope;
  capsule(on(length - head - edge), on(length + ahead), wide + edge * (slope + std::sqrt(1 + slope * slope)), 0, colour,
          Ends::square);
}

void OverlayPass::draw(const DrawList& list, const shade::Canvas& canvas, const float* depth) {
  begin(list, canvas);
  for (const bool behind : {true, false}) {
    depth_ = behind ? depth : nullptr;
    for (const LineItem& line : list.lines)
      if (line.hidden_behind == behind && line.outline) polyline(line, 1.2f, kOutline);
    for (const LineItem& line : list.lines)
      if (line.hidden_behind == behind) polyline(line, 0, line.colour);
  }
  for (const ArrowItem& item : list.arrows) {
    arrow(item, 1.4f, kOutline);
    arrow(item, 0, item.colour);
  }
  for (const MarkerItem& marker : list.markers) {
    Pixel a{}, b{};
    if (!project(marker.at, marker.at, a, b)) continue;
    capsule(a, b, marker.radius * scale_ + 1.4f * scale_, marker.radius * scale_ + 1.4f * scale_, kOutline);
    capsule(a, b, marker.radius * scale_, marker.radius * scale_, marker.colour);
  }
}

}  // namespace render::gl
