// A camera and a ball: pictures whose answer is known in closed form.
#pragma once

#include <cmath>

#include "render/draw_list.h"

namespace render::test {

/// Looks along +y from `eye`, z up. `tan_half` is the tangent of half the vertical field of view.
inline View look_along_y(const Float3& eye, float tan_half, float aspect) {
  View v;
  v.eye = eye;
  // rows of world to eye: right = x, up = z, back = -y
  v.world_to_eye = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, -eye[0], -eye[2], eye[1], 1};
  const float near = 0.1f, far = 500.0f;
  v.eye_to_clip = {1 / (tan_half * aspect),        0, 0, 0, 0, 1 / tan_half, 0, 0, 0, 0, -(far + near) / (far - near), -1, 0, 0,
                   -2 * far * near / (far - near), 0};
  return v;
}

/// Looks straight down on x, y, x to the right; `extent` [m] from bottom to top.
inline View look_down(float x, float y, float extent, float aspect) {
  View v;
  v.eye = {x, y, 50};
  v.orthographic = true;
  v.vertical_extent = static_cast<double>(extent);
  v.world_to_eye = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -50, 1};
  const float near = 0.1f, far = 100.0f;
  v.eye_to_clip = {2 / (extent * aspect),        0, 0, 0, 0, 2 / extent, 0, 0, 0, 0, -2 / (far - near), 0, 0, 0,
                   -(far + near) / (far - near), 1};
  return v;
}

inline EllipsoidItem ball(const Float3& at, double radius) {
  EllipsoidItem item;
  item.shape = {Vec3::Constant(radius), 2};
  item.model = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, at[0], at[1], at[2], 1};
  item.material.colour = {0.8f, 0.02f, 0.02f};
  return item;
}

/// Nothing but plain ground beside the road and above it: no marking is near.
inline DrawList plain(const View& view) {
  DrawList list;
  list.view = view;
  list.road.road = true;
  list.road.width = 400;
  list.road.lanes = 1;
  list.sky.haze = 0;
  return list;
}

}  // namespace render::test
