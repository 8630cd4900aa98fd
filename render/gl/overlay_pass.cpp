#include "render/gl/overlay_pass.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "render/gl/shaders.h"
#include "render/matrix.h"

namespace render::gl {
namespace {

constexpr float kNearPlane = 0.05f;  // clip w below which a point is behind the camera
constexpr float kOwn = 0.5f;         // [m] what hides a faint thing stands before it by more
constexpr float kFaint = 0.25f;      // [-] of the opacity there
constexpr float kPad = 1;            // [pixels] around what is drawn, for its soft edge
const Float4 kOutline{0.05f, 0.05f, 0.06f, 0.85f};

constexpr std::size_t kFloats = 12;  // a vertex: corner 3, tint 4, shape 3, extent 2

/// A quadrilateral by its corners: at the end of a sign, on a side.
template <class Corner>
void two_triangles(const Corner& corner) {
  corner(-1.f, -1.f);
  corner(1.f, -1.f);
  corner(1.f, 1.f);
  corner(-1.f, -1.f);
  corner(1.f, 1.f);
  corner(-1.f, 1.f);
}

}  // namespace

OverlayPass::OverlayPass()
    : in_front_("", glsl::line_vert, glsl::line_frag),
      behind_(std::string("#define BEHIND_THINGS\n") + glsl::hidden, glsl::line_vert, glsl::line_frag) {
  lay_out(array_, buffer_, {3, 4, 3, 2});
}

/// Of a point in clip coordinates, moved towards the eye by what may hide it.
float OverlayPass::depth_of(const Eigen::Vector4f& c) const {
  const float w = c[3] + per_depth_[1] * towards_eye_;
  return w < kNearPlane ? 0 : (c[2] + per_depth_[0] * towards_eye_) / w * 0.5f + 0.5f;
}

bool OverlayPass::project(const Float3& a, const Float3& b, Pixel& pa, Pixel& pb) const {
  using Eigen::Vector4f;
  Vector4f ca = clip_ * Vector4f(a[0], a[1], a[2], 1), cb = clip_ * Vector4f(b[0], b[1], b[2], 1);
  if (ca[3] < kNearPlane && cb[3] < kNearPlane) return false;
  const auto cut = [](Vector4f& behind, const Vector4f& front) {
    if (behind[3] < kNearPlane) behind += (kNearPlane - behind[3]) / (front[3] - behind[3]) * (front - behind);
  };
  cut(ca, cb);
  cut(cb, ca);
  const auto pixel = [&](const Vector4f& c) {
    return Pixel{(c[0] / c[3] * 0.5f + 0.5f) * static_cast<float>(width_),
                 (c[1] / c[3] * 0.5f + 0.5f) * static_cast<float>(height_), depth_of(c)};
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

void OverlayPass::vertex(const Pixel& p, float off_x, float off_y, const Shape& shape, const Float4& colour) {
  vertices_.insert(vertices_.end(),
                   {p.x + off_x, p.y + off_y, p.z + p.slope_x * off_x + p.slope_y * off_y, colour[0], colour[1], colour[2],
                    colour[3], shape.across, shape.along, shape.half, shape.length, shape.square ? 1.0f : 0.0f});
}

/// The rectangle around a piece; the shader finds its distance from it.
void OverlayPass::capsule(const Pixel& a, const Pixel& b, float half_a, float half_b, const Float4& colour, Ends ends) {
  const float length = std::hypot(b.x - a.x, b.y - a.y);
  const bool point = length <= 1e-4f, square = ends == Ends::square;
  const float dx = point ? 1 : (b.x - a.x) / length, dy = point ? 0 : (b.y - a.y) / length;
  const auto corner = [&](const Pixel& p, float half, float along_sign, float side) {
    const float across = side * (std::max(half_a, half_b) + kPad), along = along_sign * (square ? kPad : half + kPad);
    const float at = along_sign < 0 ? along : length + along;
    // a taper goes on beyond its ends, so that its width is linear over the piece
    if (square && !point) half = half_a + (half_b - half_a) * at / length;
    vertex(p, dx * along - dy * across, dy * along + dx * across, {across, at, half, point ? 0 : length, square}, colour);
  };
  two_triangles([&](float sign, float side) { sign < 0 ? corner(a, half_a, -1, side) : corner(b, half_b, 1, side); });
}

/// A line of one width. Pieces that meet share the corners of a mitre, so that no pixel is painted twice and what is not quite
/// opaque has no beads; where the line turns sharply for their length, each ends round.
void OverlayPass::band(const std::vector<Pixel>& run, float half, const Float4& colour) {
  if (run.size() == 1) return capsule(run[0], run[0], half, half, colour);
  const float wide = half + kPad;
  struct Way {
    float dx, dy, length;
  };
  const auto way = [&](std::size_t i) {
    const float x = run[i + 1].x - run[i].x, y = run[i + 1].y - run[i].y, length = std::hypot(x, y);
    return Way{x / length, y / length, length};
  };
  struct End {
    float x, y;  // [pixels] from the line's place to its left corner
    bool joined;
  };
  const auto joint = [&](const Way& before, const Way& after) {
    const float cosine = before.dx * after.dx + before.dy * after.dy, sine = std::abs(before.dx * after.dy - before.dy * after.dx);
    // the corner reaches wide * tan(half the turn) into both pieces
    const bool joined = cosine > 0 && wide * sine < 0.5f * (1 + cosine) * std::min(before.length, after.length);
    return End{-wide * (before.dy + after.dy) / (1 + cosine), wide * (before.dx + after.dx) / (1 + cosine), joined};
  };
  Way w = way(0);
  End from{0, 0, false};
  for (std::size_t i = 0; i + 1 < run.size(); ++i) {
    const bool last = i + 2 == run.size();
    const Way next = last ? w : way(i + 1);
    const End to = last ? End{0, 0, false} : joint(w, next);
    // a joined end is told to lie farther on: nothing is beyond it
    const float before = from.joined ? wide : 0, length = before + w.length + (to.joined ? wide : 0);
    const auto corner = [&](const Pixel& p, const End& end, float sign, float side) {
      const float off_x = end.joined ? side * end.x : sign * wide * w.dx - side * wide * w.dy;
      const float off_y = end.joined ? side * end.y : sign * wide * w.dy + side * wide * w.dx;
      const float along = before + (sign > 0 ? w.length : 0) + off_x * w.dx + off_y * w.dy;
      vertex(p, off_x, off_y, {side * wide, along, half, length, false}, colour);
    };
    const Pixel &a = run[i], &b = run[i + 1];
    two_triangles([&](float sign, float side) { sign < 0 ? corner(a, from, -1, side) : corner(b, to, 1, side); });
    w = next;
    from = to;
  }
}

void OverlayPass::polyline(const LineItem& line, float extra, const Float4& colour) {
  constexpr float kShort = 1, kEnd = 1e-3f;  // [pixels] a point nearer than this to the last tells nothing, be it the line's end
  // a line thinner than a pixel would be seen where it meets the middle of one, and hardly between
  const float half = 0.5f * std::max(line.width * scale_, 1.0f) + extra * scale_;
  std::vector<Pixel> run;
  Pixel last{};
  const auto end = [&] {
    if (!run.empty()) band(run, half, colour);
    run.clear();
  };
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    Pixel a{}, b{};
    if (!project(line.points[i - 1], line.points[i], a, b)) {
      end();
      continue;
    }
    if (line.normals.size() == line.points.size()) {
      lie_on(line.points[i - 1], line.normals[i - 1], a);
      lie_on(line.points[i], line.normals[i], b);
    }
    if (a.x != last.x || a.y != last.y) end();  // one was cut before the eye
    if (run.empty()) run.push_back(a);
    const float away = std::hypot(b.x - run.back().x, b.y - run.back().y);
    if (away >= (i + 1 == line.points.size() ? kEnd : kShort)) run.push_back(b);
    last = b;
  }
  end();
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
    return Pixel{a.x + (b.x - a.x) * s, a.y + (b.y - a.y) * s, a.z + (b.z - a.z) * s};
  };
  capsule(a, on(length - head), half + edge, half + edge, colour);
  // the outline of a wedge as far from its sides as from its base: its tip moves on by more than that
  const float slope = wide / head, ahead = edge * std::sqrt(1 + slope * slope) / slope;
  capsule(on(length - head - edge), on(length + ahead), wide + edge * (slope + std::sqrt(1 + slope * slope)), 0, colour,
          Ends::square);
}

void OverlayPass::gather(const DrawList& list, Occluded group) {
  towards_eye_ = group == Occluded::faint ? kOwn : 0;
  for (const LineItem& line : list.lines)
    if (line.occluded == group && line.outline) polyline(line, 1.2f, kOutline);
  for (const LineItem& line : list.lines)
    if (line.occluded == group) polyline(line, 0, line.colour);
  for (const ArrowItem& item : list.arrows) {
    if (item.occluded != group) continue;
    arrow(item, 1.4f, kOutline);
    arrow(item, 0, item.colour);
  }
  for (const MarkerItem& marker : list.markers) {
    Pixel a{}, b{};
    if (marker.occluded != group || !project(marker.at, marker.at, a, b)) continue;
    capsule(a, b, marker.radius * scale_ + 1.4f * scale_, marker.radius * scale_ + 1.4f * scale_, kOutline);
    capsule(a, b, marker.radius * scale_, marker.radius * scale_, marker.colour);
  }
}

void OverlayPass::begin(const DrawList& list, int width, int height) {
  const Mat4 eye_to_clip = from_gl(list.view.eye_to_clip);
  clip_ = (eye_to_clip * from_gl(list.view.world_to_eye)).cast<float>();
  per_depth_ = {static_cast<float>(eye_to_clip(2, 2)), static_cast<float>(eye_to_clip(3, 2))};
  width_ = width;
  height_ = height;
  scale_ = static_cast<float>(height) / 1080 * list.scale;
  vertices_.clear();
  gather(list, Occluded::hidden);
  hidden_end_ = vertices_.size() / kFloats;
  gather(list, Occluded::faint);
  faint_end_ = vertices_.size() / kFloats;
  gather(list, Occluded::shown);
  if (vertices_.empty()) return;
  upload(buffer_, vertices_);
  reach_ = around(vertices_.data(), vertices_.size() / kFloats, kFloats, width, height);
  if (reach_.width > 0 && reach_.height > 0) target_.begin(reach_, width, height);
}

void OverlayPass::draw(const Program& program, const Rectangle& r, std::size_t first, std::size_t count) {
  const Rectangle seen = both(r, reach_);
  if (count == 0 || seen.width == 0 || seen.height == 0) return;
  target_.bind();
  target_.confine(seen);
  program.use();
  program.set("per_viewport", target_.per_viewport());
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glBindVertexArray(*array_);
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(first), static_cast<GLsizei>(count));
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
}

void OverlayPass::draw_behind(const Rectangle& r) {
  draw(in_front_, r, 0, faint_end_);
}

void OverlayPass::draw_behind(const ObjectPass& objects, const Rectangle& r, int samples) {
  if (faint_end_ == 0) return;
  objects.bind_depth(behind_, samples, reach_.x, reach_.y);
  behind_.set("occluded", 0.0f);
  draw(behind_, r, 0, hidden_end_);
  behind_.set("occluded", kFaint);
  draw(behind_, r, hidden_end_, faint_end_ - hidden_end_);
}

void OverlayPass::finish(const shade::Canvas& canvas) {
  if (vertices_.empty() || reach_.width == 0 || reach_.height == 0) return;
  draw(in_front_, reach_, faint_end_, vertices_.size() / kFloats - faint_end_);
  constexpr int kStrip = 32;  // rows at a time
  const int top = reach_.y + reach_.height;
  lines_.resize(4 * kStrip * static_cast<std::size_t>(reach_.width));
  for (int low = reach_.y; low < top; low += kStrip) {
    const Rectangle strip{reach_.x, low, reach_.width, std::min(kStrip, top - low)};
    target_.read(strip, lines_.data());
    const std::uint8_t* from = lines_.data();
    for (int y = low; y < low + strip.height; ++y) {
      std::uint8_t* to = canvas.pixels + 4 * (y * canvas.pitch + strip.x);
      for (int x = 0; x < strip.width; ++x, from += 4, to += 4) {
        if (from[3] == 0) continue;
        for (int c = 0; c < 3; ++c) to[c] = static_cast<std::uint8_t>(from[c] + (to[c] * (255 - from[3]) + 127) / 255);
      }
    }
  }
}

}  // namespace render::gl
