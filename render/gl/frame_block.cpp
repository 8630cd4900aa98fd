#include "render/gl/frame_block.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/frames.h"
#include "render/matrix.h"

namespace render::gl {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kOcclusionReach = 1.2;  // [m] beyond a caster the occlusion on the ground is under one grey level
constexpr double kNear = 145;            // [m] where the kernel without horizon serves; it begins to fade in at 150
constexpr double kShadowReach = 80;      // [m] from the eye; farther away a shadow is a few pixels

void put(const Vector3d& v, double w, float* out) {
  for (const double number : {v[0], v[1], v[2], w}) *out++ = static_cast<float>(number);
}

void put(const Matrix4d& m, float* out) {
  for (Eigen::Index i = 0; i < m.size(); ++i) *out++ = static_cast<float>(m.data()[i]);
}

std::vector<Vector3d> corners(const std::vector<CasterBox>& boxes) {
  std::vector<Vector3d> out;
  for (const CasterBox& b : boxes)
    for (int k = 0; k < 8; ++k) out.push_back(b.centre + b.half_edges * Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
  return out;
}

// pixels around each group of eight or four points, with a margin. What lies wholly behind the eye is not seen; the whole picture
// as soon as one group lies on both sides
Rectangle seen(const std::vector<Vector3d>& points, std::size_t group, const Matrix4d& world_to_clip, int width, int height) {
  double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
  for (std::size_t first = 0; first < points.size(); first += group) {
    std::size_t behind = 0;
    for (std::size_t i = first; i < first + group; ++i)
      behind += (world_to_clip.row(3) * points[i].homogeneous())[0] < 1e-3 ? 1 : 0;
    if (behind == group) continue;
    if (behind > 0) return {0, 0, width, height};
    for (std::size_t i = first; i < first + group; ++i) {
      const Vector4d c = world_to_clip * points[i].homogeneous();
      x0 = std::min(x0, c[0] / c[3]);
      x1 = std::max(x1, c[0] / c[3]);
      y0 = std::min(y0, c[1] / c[3]);
      y1 = std::max(y1, c[1] / c[3]);
    }
  }
  if (x0 > x1) return {};
  const auto pixel = [](double ndc, int size, int margin) {
    return std::clamp(static_cast<int>(std::floor((std::clamp(ndc, -2.0, 2.0) + 1) / 2 * size)) + margin, 0, size);
  };
  const int left = pixel(x0, width, -3), right = pixel(x1, width, 4), low = pixel(y0, height, -3), high = pixel(y1, height, 4);
  if (right <= left || high <= low) return {};
  return {left, low, right - left, high - low};
}

// the ray of a pixel, linear in its place: from the near plane to one not at infinity, where a float has run out of digits
void set_rays(const Matrix4d& clip_to_world, int width, int height, shade::FrameData& f) {
  const auto set = [&](double depth, float* at_0, float* per_x, float* per_y) {
    const auto at = [&](double x, double y) -> Vector3d {
      const Vector4d p = clip_to_world * Vector4d(x, y, depth, 1);
      return p.head<3>() / p[3];
    };
    const Vector3d corner = at(-1, -1);
    put(corner, 0, at_0);
    put((at(1, -1) - corner) / width, 0, per_x);
    put((at(-1, 1) - corner) / height, 0, per_y);
  };
  set(-1, f.near_0, f.near_x, f.near_y);
  set(0.9, f.far_0, f.far_x, f.far_y);
}

// the horizon crosses the left and right edge of the picture at these rows; above both there is sky alone
int sky_rows(const Matrix4d& clip_to_world, bool orthographic, int height) {
  if (orthographic) return height;
  double highest = -1;
  for (const double x : {-1.0, 1.0}) {
    auto rise = [&](double y) {
      const Vector4d a = clip_to_world * Vector4d(x, y, -1, 1), b = clip_to_world * Vector4d(x, y, 0.9, 1);
      return (b.head<3>() / b[3] - a.head<3>() / a[3]).z();
    };
    // linear along a column, for both points lie on planes of constant depth
    const double low = rise(-1), high = rise(1);
    if (high <= low) return height;  // upside down
    highest = std::max(highest, -1 + 2 * -low / (high - low));
  }
  return std::clamp(static_cast<int>(std::ceil((highest + 1) / 2 * height)) + 2, 0, height);
}

// below this row all ground is nearer than kNear
int near_rows(const Matrix4d& clip_to_world, const Vector3d& eye, double ground, bool orthographic, int sky_from, int height) {
  if (orthographic) return sky_from;
  auto distance = [&](int row) {
    double farthest = 0;
    for (const double x : {-1.0, 0.0, 1.0}) {
      const Vector4d c = clip_to_world * Vector4d(x, 2.0 * row / height - 1, 0.9, 1);
      const Vector3d d = (c.head<3>() / c[3] - eye).normalized();
      farthest = std::max(farthest, d.z() < 0 && eye.z() > ground ? (ground - eye.z()) / d.z() : 1e9);
    }
    return farthest;
  };
  // distance grows upwards: the last row that is near
  if (distance(0) > kNear) return 0;
  return first_without(1, sky_from, [&](int row) { return distance(row) < kNear; }) - 1;
}

// the ground rectangles that hold each caster's shadow and occlusion
std::vector<Vector3d> shaded_ground(const std::vector<CasterBox>& boxes, const Vector3d& to_sun, double ground) {
  std::vector<Vector3d> out;
  for (const CasterBox& b : boxes) {
    Eigen::AlignedBox2d box;
    for (const Vector3d& c : corners({b})) {
      const double up = std::max(c.z() - ground, 0.0);
      box.extend(c.head<2>()).extend((c - to_sun * (up / std::max(to_sun.z(), 0.05))).head<2>());
    }
    for (int k = 0; k < 4; ++k)
      out.emplace_back(k & 1 ? box.max()[0] + kOcclusionReach : box.min()[0] - kOcclusionReach,
                       k & 2 ? box.max()[1] + kOcclusionReach : box.min()[1] - kOcclusionReach, ground);
  }
  return out;
}

void fit_shadow(const std::vector<CasterBox>& boxes, const Vector3d& to_sun, int map_size, FrameSetup& out) {
  const Vector3d side = (std::abs(to_sun.z()) < 0.99 ? Vector3d::UnitZ() : Vector3d::UnitX()).cross(to_sun).normalized();
  Eigen::Matrix3d R_LW;  // light axes as rows; z towards the sun
  R_LW << side.transpose(), to_sun.cross(side).transpose(), to_sun.transpose();
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : corners(boxes)) box.extend(R_LW * p);
  const Eigen::Array3d lower = box.min().array() - 0.1, upper = box.max().array() + 0.1;
  const Eigen::Array3d size = upper - lower;
  Matrix4d clip = Matrix4d::Identity();
  clip.topLeftCorner<3, 3>() = R_LW;
  Matrix4d scale = Matrix4d::Identity();
  for (int i = 0; i < 3; ++i) {
    scale(i, i) = 2 / size[i];
    scale(i, 3) = -(upper[i] + lower[i]) / size[i];
  }
  scale.row(2) *= -1;  // nearest to the sun is -1
  scale(2, 3) = (upper[2] + lower[2]) / size[2];
  out.world_to_shadow_clip = scale * clip;
  Matrix4d half = Matrix4d::Identity() * 0.5;
  half.col(3) = Vector4d(0.5, 0.5, 0.5, 1);
  put(half * out.world_to_shadow_clip, out.data.world_to_shadow);
  const Eigen::Array2d texel = size.head<2>() / map_size;
  put({texel[0], texel[1], size[2]}, std::max(0.012, 1.3 * texel.maxCoeff()), out.data.shadow);
  put({size[0], size[1], 0}, 0, out.data.shadow_size);
}

// where on the ground the occlusion map lies: around what stands low
void fit_occlusion(const std::vector<const CasterBox*>& low, shade::FrameData& f) {
  Eigen::AlignedBox2d box;
  for (const CasterBox* b : low)
    for (const Vector3d& c : corners({*b})) box.extend(c.head<2>());
  const Eigen::Vector2d size = box.sizes().array() + 2 * kOcclusionReach;
  put({box.min()[0] - kOcclusionReach, box.min()[1] - kOcclusionReach, size[0]}, size[1], f.occlusion);
}

// rows of the map from world to the caster's own axes; `unit`: its surface at distance one
void put_rows(const CasterBox& b, bool unit, float* rows) {
  for (int i = 0; i < 3; ++i) {
    const Vector3d edge = b.half_edges.col(i);
    const Vector3d row = edge / (unit ? edge.squaredNorm() : edge.norm());
    put(row, -row.dot(b.centre), rows + 4 * i);
  }
}

void put_occluders(const std::vector<CasterBox>& boxes, double ground, FrameSetup& frame) {
  OccluderRows& out = frame.occluders;
  // the round ones nearest to the ground hide most of it; stable order keeps equal scenes equal
  std::vector<const CasterBox*> low;
  for (const CasterBox& b : boxes)
    if (b.round && b.occludes && b.centre.z() - ground < 1.3) low.push_back(&b);
  std::stable_sort(low.begin(), low.end(), [](const CasterBox* a, const CasterBox* b) { return a->centre.z() < b->centre.z(); });
  out.rounds = std::min(low.size(), OccluderRows::kMostRound);
  low.resize(out.rounds);
  for (std::size_t i = 0; i < out.rounds; ++i) put_rows(*low[i], true, &out.round_rows[12 * i]);
  for (const CasterBox& b : boxes) {
    if (b.round || out.boxes == OccluderRows::kMostBoxes) continue;
    const std::size_t i = out.boxes++;
    put_rows(b, false, &out.box_rows[12 * i]);
    put(b.half_edges.colwise().norm().transpose(), 0, &out.box_half[4 * i]);
    low.push_back(&b);
  }
  if (!low.empty()) fit_occlusion(low, frame.data);
}

}  // namespace

Rectangle both(const Rectangle& a, const Rectangle& b) {
  const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  return {x, y, std::max(0, std::min(a.x + a.width, b.x + b.width) - x), std::max(0, std::min(a.y + a.height, b.y + b.height) - y)};
}

Rectangle around(const float* places, std::size_t count, std::size_t stride, int width, int height) {
  Eigen::AlignedBox2f box;
  for (const float* p = places; p < places + count * stride; p += stride) box.extend(Eigen::Vector2f::Map(p));
  const auto on = [](float v, int end) { return static_cast<int>(std::clamp(v, 0.0f, static_cast<float>(end))); };
  const int x = on(box.min()[0], width), y = on(box.min()[1], height);
  return {x, y, on(box.max()[0] + 1, width) - x, on(box.max()[1] + 1, height) - y};
}

bool same_background(const shade::FrameData& a, const shade::FrameData& b) {
  return std::memcmp(&a, &b, offsetof(shade::FrameData, world_to_shadow)) == 0;
}

FrameSetup set_up_frame(const DrawList& list, const std::vector<CasterBox>& boxes, int width, int height, int shadow_map_size) {
  FrameSetup out;
  const Matrix4d world_to_eye = from_gl(list.view.world_to_eye);
  out.world_to_clip = from_gl(list.view.eye_to_clip) * world_to_eye;
  const Vector3d to_sun(std::cos(list.sky.sun_elevation) * std::cos(list.sky.sun_azimuth),
                        std::cos(list.sky.sun_elevation) * std::sin(list.sky.sun_azimuth), std::sin(list.sky.sun_elevation));
  shade::FrameData& f = out.data;
  const Vector3d eye(list.view.eye[0], list.view.eye[1], list.view.eye[2]);
  put(out.world_to_clip.inverse(), f.clip_to_world);
  put(eye, list.view.orthographic ? 1 : 0, f.eye);
  put(-world_to_eye.block<1, 3>(2, 0).transpose(), 0, f.forward);
  put(to_sun, list.sky.haze, f.sun);
  put({list.road.height, list.road.width / 2, list.road.centre_y}, list.road.lanes, f.ground);
  put({list.road.road ? 1.0 : 0.0, list.road.metre_grid ? 1.0 : 0.0, list.road.zebra ? 1.0 : 0.0}, list.road.zebra_x, f.road);
  put({2.0 / width, 2.0 / height, 0}, 0, f.frame);
  put({0, 0, 1}, 1, f.occlusion);
  set_rays(out.world_to_clip.inverse(), width, height, f);
  out.sky_from = sky_rows(out.world_to_clip.inverse(), list.view.orthographic, height);
  out.near_to = near_rows(out.world_to_clip.inverse(), eye, list.road.height, list.view.orthographic, out.sky_from, height);
  out.objects = seen(corners(boxes), 8, out.world_to_clip, width, height);
  // a shadow map stretched to the horizon would be coarse everywhere
  std::vector<CasterBox> near;
  for (const CasterBox& box : boxes)
    if (box.casts && (list.view.orthographic || (box.centre - eye).norm() - box.half_edges.norm() < kShadowReach))
      near.push_back(box);
  out.casts = !near.empty();
  if (out.casts) {
    out.shade = seen(shaded_ground(near, to_sun, list.road.height), 4, out.world_to_clip, width, height);
    fit_shadow(near, to_sun, shadow_map_size, out);
    put_occluders(near, list.road.height, out);
  }
  return out;
}

}  // namespace render::gl
