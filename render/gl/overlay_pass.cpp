#include "render/gl/overlay_pass.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "render/gl/gl.h"
#include "render/gl/shaders.h"
#include "render/matrix.h"

namespace render::gl {
namespace {

constexpr int kFloats = 12;     // per vertex: clip 3, tint 4, shape 3, extent 2
constexpr float kNear = 0.05f;  // clip w below which a point is behind the camera
const Float4 kOutline{0.05f, 0.05f, 0.06f, 0.85f};

}  // namespace

OverlayPass::OverlayPass() : program_("", kOverlayVertex, kOverlayFragment) {
  glGenVertexArrays(1, &array_);
  glGenBuffers(1, &buffer_);
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  const int sizes[] = {3, 4, 3, 2};
  std::uintptr_t offset = 0;
  for (unsigned i = 0; i < 4; ++i) {
    glVertexAttribPointer(i, sizes[i], GL_FLOAT, GL_FALSE, kFloats * sizeof(float), reinterpret_cast<const void*>(offset));
    glEnableVertexAttribArray(i);
    offset += static_cast<std::uintptr_t>(sizes[i]) * sizeof(float);
  }
}

OverlayPass::~OverlayPass() {
  glDeleteBuffers(1, &buffer_);
  glDeleteVertexArrays(1, &array_);
}

void OverlayPass::begin(const DrawList& list, int width, int height) {
  const Mat4 m = from_gl(list.view.eye_to_clip) * from_gl(list.view.world_to_eye);
  for (int i = 0; i < 16; ++i) clip_[i] = static_cast<float>(m.data()[i]);
  width_ = static_cast<float>(width);
  height_ = static_cast<float>(height);
  scale_ = height_ / 1080 * list.scale;
  vertices_.clear();
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
    return Pixel{(c[0] / c[3] * 0.5f + 0.5f) * width_, (c[1] / c[3] * 0.5f + 0.5f) * height_, c[2] / c[3] * 0.5f + 0.5f, true};
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

void OverlayPass::capsule(const Pixel& a, const Pixel& b, float half_a, float half_b, const Float4& colour, Ends ends) {
  float dx = b.x - a.x, dy = b.y - a.y;
  const float length = std::hypot(dx, dy);
  if (length > 1e-4f) {
    dx /= length;
    dy /= length;
  } else {
    dx = 1;
    dy = 0;
  }
  const float pad = 1;
  const bool square = ends == Ends::square;
  auto vertex = [&](const Pixel& p, float half, float along_sign, float side) {
    const float across = side * (half + pad), along = along_sign * (square ? pad : half + pad);
    const float at = along_sign < 0 ? along : length + along;
    // a taper goes on beyond its ends, so that its width is linear over the piece
    if (square && length > 1e-4f) half = half_a + (half_b - half_a) * at / length;
    const float off_x = dx * along - dy * across, off_y = dy * along + dx * across;
    const float values[kFloats] = {p.x + off_x, p.y + off_y, std::clamp(p.z + p.slope_x * off_x + p.slope_y * off_y, 0.f, 1.f),
                                   colour[0],   colour[1],   colour[2],
                                   colour[3],   across,      at,
                                   half,        length,      square ? 1.0f : 0.0f};
    vertices_.insert(vertices_.end(), values, values + kFloats);
  };
  vertex(a, half_a, -1, -1);
  vertex(b, half_b, 1, -1);
  vertex(b, half_b, 1, 1);
  vertex(a, half_a, -1, -1);
  vertex(b, half_b, 1, 1);
  vertex(a, half_a, -1, 1);
}

void OverlayPass::polyline(const LineItem& line, float extra, const Float4& colour) {
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

void OverlayPass::arrow(const ArrowItem& item, float extra, const Float4& colour) {
  Pixel a{}, b{};
  if (!project(item.from, item.to, a, b)) return;
  const float half = 0.5f * item.width * scale_, edge = extra * scale_;
  const float length = std::hypot(b.x - a.x, b.y - a.y);
  if (length < 2 * half) return;  // seen from its end: the marker tells of it
  const float head = std::min(6.0f * half, 0.75f * length), wide = 0.42f * head;
  auto on = [&](float pixels) {
    const float s = pixels / length;
    return Pixel{a.x + (b.x - a.x) * s, a.y + (b.y - a.y) * s, a.z + (b.z - a.z) * s, true};
  };
  capsule(a, on(length - head), half + edge, half + edge, colour);
  // the outline of a wedge as far from its sides as from its base: its tip moves on by more than that
  const float slope = wide / head, ahead = edge * std::sqrt(1 + slope * slope) / slope;
  capsule(on(length - head - edge), on(length + ahead), wide + edge * (slope + std::sqrt(1 + slope * slope)), 0, colour,
          Ends::square);
}

void OverlayPass::flush(bool depth_tested) {
  if (vertices_.empty()) return;
  program_.use();
  program_.set("frame", width_, height_);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  if (depth_tested)
    glEnable(GL_DEPTH_TEST);
  else
    glDisable(GL_DEPTH_TEST);
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices_.size() * sizeof(float)), vertices_.data(), GL_STREAM_DRAW);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices_.size() / kFloats));
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  vertices_.clear();
}

void OverlayPass::draw(const DrawList& list, int width, int height) {
  begin(list, width, height);
  for (const bool behind : {true, false}) {
    for (const LineItem& line : list.lines)
      if (line.hidden_behind == behind && line.outline) polyline(line, 1.2f, kOutline);
    for (const LineItem& line : list.lines)
      if (line.hidden_behind == behind) polyline(line, 0, line.colour);
    flush(behind);
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
  flush(false);
}

}  // namespace render::gl
