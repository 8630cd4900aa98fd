// Vertices brought to the samples of a picture.
#pragma once

#include "render/shade/kernels.h"
#include "render/shade/lanes.h"

namespace render::shade {
namespace {

constexpr float kSub = 64;          // places to a sample, along each side
constexpr float kFarthest = 32000;  // [samples] from the corner of the picture: beyond, OpenGL cuts

LANES F snapped(F samples) {
  return floor(clamp(samples, -kFarthest, kFarthest) * kSub + 0.5f) * (1 / kSub);
}

void project(const Projection& to, const Vertices& in, const Corners& out) {
  const Projection p = to;
  for (int i = 0; i < in.count; i += kLanes) {
    const F x = load(in.x + i), y = load(in.y + i), z = load(in.z + i);
    const auto clip = [&](int row) {
      const float* m = p.model_to_clip + row;
      return m[0] * x + m[4] * y + m[8] * z + m[12];
    };
    const F w = clip(3), per_w = 1.0f / (w > 1e-6f ? w : all(1e-6f));
    const F cx = clip(0), cy = clip(1), cz = clip(2);
    const F sx = (cx * per_w + 1.0f) * p.half_width, sy = (cy * per_w + 1.0f) * p.half_height;
    const I before = (w > 1e-6f) & (abs(sx) < kFarthest) & (abs(sy) < kFarthest);
    F record[kLanes] = {before ? snapped(sx) : (cx + w) * p.half_width,
                        before ? snapped(sy) : (cy + w) * p.half_height,
                        before ? cz * per_w * 0.5f + 0.5f : (cz + w) * 0.5f,
                        before ? all(1.0f) : w,
                        before ? per_w : all(1.0f),
                        all(0.0f),
                        all(0.0f),
                        all(0.0f)};
    if (out.places) {
      const float* r = p.model_to_world;
      const F nx = load(in.normal_x + i), ny = load(in.normal_y + i), nz = load(in.normal_z + i);
      for (int k = 0; k < 3; ++k) record[5 + k] = r[k] * nx + r[4 + k] * ny + r[8 + k] * nz;
      F place[kLanes] = {x, y, z, r[2] * x + r[6] * y + r[10] * z + (r[14] - p.ground), all(0.0f), all(0.0f), all(0.0f), all(0.0f)};
      turn(place);
      for (int k = 0; k < kLanes; ++k) __builtin_memcpy(out.places + 4 * (i + k), &place[k], 4 * sizeof(float));
    }
    turn(record);
    for (int k = 0; k < kLanes; ++k) store(record[k], out.records + kLanes * (i + k));
  }
}

}  // namespace
}  // namespace render::shade
