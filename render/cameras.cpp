#include "render/cameras.h"

#include <algorithm>
#include <cmath>

#include "render/matrix.h"

namespace render {

int body_of_name(const engine::Recording& recording, const std::string& name) {
  const auto& names = recording.body_names;
  for (const std::string& candidate : {name, name + "/hips", name + "/waist", name + "/torso"}) {
    const auto at = std::find(names.begin(), names.end(), candidate);
    if (at != names.end()) return static_cast<int>(at - names.begin());
  }
  return -1;
}

Vec3 followed_point(const Camera& camera, const engine::Recording& recording, double time) {
  const int body = camera.follow.empty() ? -1 : body_of_name(recording, camera.follow);
  if (body < 0) return Vec3::Zero();
  auto place = [&](double t) -> Vec3 {
    const auto s = recording.at(t);
    return {s.bodies[static_cast<std::size_t>(body)].X_WB.p.x(), s.bodies[static_cast<std::size_t>(body)].X_WB.p.y(), 0};
  };
  if (camera.smoothing <= 0) return place(time);
  // mean over a window around now: no lag, no jerk; beyond the ends the subject moves on at its end speed
  constexpr int kSamples = 9;
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const double t = time + camera.smoothing * (2.0 * i / (kSamples - 1) - 1);
    const double inside = std::clamp(t, 0.0, recording.end_time());
    const auto s = recording.at(inside);
    Vec3 v = s.bodies[static_cast<std::size_t>(body)].V_WB.v;
    v.z() = 0;
    sum += place(inside) + (t - inside) * v;
  }
  return sum / kSamples;
}

namespace {

/// The body whose motion an eye shares: a person sees with the head.
int carrier(const Camera& camera, const engine::Recording& recording) {
  if (camera.follow.empty()) return -1;
  const auto at = std::find(recording.body_names.begin(), recording.body_names.end(), camera.follow + "/head");
  if (at != recording.body_names.end()) return static_cast<int>(at - recording.body_names.begin());
  return body_of_name(recording, camera.follow);
}

/// Cubic through the knots whose slope at each is that of its neighbours (Catmull & Rom 1974, unequal times); at rest beyond both
/// ends.
Vec3 along_path(const std::vector<CameraKnot>& path, Vec3 CameraKnot::*what, double time) {
  if (time <= path.front().time) return path.front().*what;
  if (time >= path.back().time) return path.back().*what;
  const auto next = std::upper_bound(path.begin(), path.end(), time, [](double t, const CameraKnot& k) { return t < k.time; });
  const std::size_t b = static_cast<std::size_t>(next - path.begin()), a = b - 1;
  auto slope = [&](std::size_t i) -> Vec3 {
    if (i == 0 || i + 1 == path.size()) return Vec3::Zero();
    return (path[i + 1].*what - path[i - 1].*what) / (path[i + 1].time - path[i - 1].time);
  };
  const double span = path[b].time - path[a].time, s = (time - path[a].time) / span;
  const double s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * (path[a].*what) + (s3 - 2 * s2 + s) * span * slope(a) + (-2 * s3 + 3 * s2) * (path[b].*what) +
         (s3 - s2) * span * slope(b);
}

}  // namespace

View view_of(const Camera& camera, const engine::Recording& recording, double time, double aspect) {
  constexpr double kNear = 0.15, kFar = 1500;  // [m]
  const Vec3 subject = followed_point(camera, recording, time);
  Vec3 eye = camera.position, target = camera.target;
  Vec3 up = Vec3::UnitZ();
  View view;
  Mat4 projection = perspective(camera.vertical_fov, aspect, kNear, kFar);
  switch (camera.kind) {
    case CameraKind::fixed:
      if (!camera.follow.empty()) target = subject + camera.target;  // stands still and pans
      break;
    case CameraKind::follow:
      eye = subject + camera.position;
      target = subject + camera.target;
      break;
    case CameraKind::orbit: {
      const double angle = camera.orbit_start + camera.orbit_rate * time;
      target = subject + camera.target;
      eye = subject + Vec3(camera.orbit_radius * std::cos(angle), camera.orbit_radius * std::sin(angle), camera.orbit_height);
      break;
    }
    case CameraKind::eye: {
      const int body = carrier(camera, recording);
      if (body < 0) break;  // a witness stands in the world
      const Pose X_WB = recording.at(time).bodies[static_cast<std::size_t>(body)].X_WB;
      eye = X_WB * camera.position;
      target = X_WB * camera.target;
      up = X_WB.q * Vec3::UnitZ();
      break;
    }
    case CameraKind::path:
      eye = subject + along_path(camera.path, &CameraKnot::position, time);
      target = subject + along_path(camera.path, &CameraKnot::target, time);
      break;
    case CameraKind::top: {
      target = subject + camera.target;
      eye = target + Vec3(0, 0, 60);
      up = Vec3::UnitY();  // x to the right, y up: the sheet of a site plan
      const double half = 0.5 * camera.top_height;
      projection = orthographic(half * aspect, half, 1, 120);
      view.orthographic = true;
      view.vertical_extent = camera.top_height;
      break;
    }
  }
  view.world_to_eye = to_gl(look_at(eye, target, up));
  view.eye_to_clip = to_gl(projection);
  view.eye = to_float(eye);
  return view;
}

}  // namespace render
