// How much of the sun a place sees. Contact hardening: the farther the blocker, the wider the filter (Fernando 2005). Blockers are
// looked for only where the least and largest depth around leave it open, the filter runs only where some are found and some are
// not.
#pragma once

#include "render/shade/light.h"

namespace render::shade {
namespace {

constexpr float kSunSpread = 0.030f;  // [rad] wider than the true 0.0093: a hazy sun reads better

struct Lookup {
  const float* depth;
  int pitch;
  float size;  // without the rim
};

/// Depth of the texel at x, y, counted from the rim; beyond the rim it is the rim's, 1.
LANES F depth_at(const Lookup& map, F x, F y) {
  return gather(map.depth, to_int(clamp(y, 0, map.size + 1)) * map.pitch + to_int(clamp(x, 0, map.size + 1)));
}

/// Part of the four texels around x, y, counted from the rim's middle, that lie no nearer to the sun than z, by their distance.
LANES F nearer_than(const Lookup& map, F x, F y, F z) {
  x = clamp(x, 0, map.size + 0.99f);
  y = clamp(y, 0, map.size + 0.99f);
  const I i = to_int(x), j = to_int(y), at = j * map.pitch + i;
  const F s = x - to_float(i), t = y - to_float(j);
  const auto open = [&](int step) { return z <= gather(map.depth + step, at) ? all(1.0f) : all(0.0f); };
  return mix(mix(open(0), open(1), s), mix(open(map.pitch), open(map.pitch + 1), s), t);
}

/// Places spread evenly over a disc: turned by the golden angle, step by step outwards.
struct Spiral {
  V2 d;
  LANES void next() { d = {d.x * -0.7373688f - d.y * 0.6754903f, d.x * 0.6754903f - d.y * 0.7373688f}; }
};
LANES float radius(int i, int count) {
  return __builtin_sqrtf((static_cast<float>(i) + 0.5f) / static_cast<float>(count));
}

/// How depth changes from texel to texel over a surface: what lies on its plane does not shade it.
struct Slope {
  F u, v;
};
LANES Slope slope_of(const FrameData& f, const Maps& maps, const V3& n) {
  // the rows of the map's matrix are the light's axes, each over its length
  const float* m = f.world_to_shadow;
  const auto along = [&](int row, float size) { return (n.x * m[row] + n.y * m[4 + row] + n.z * m[8 + row]) * (size * size); };
  constexpr float kSteepest = 4;  // [-] beyond, the sun grazes
  const F per = -1.0f / min(along(2, f.shadow[2]), f.shadow[2] * -0.05f);
  const float texels = 1 / static_cast<float>(maps.depth_size);
  const float most_u = kSteepest * f.shadow[0] / f.shadow[2], most_v = kSteepest * f.shadow[1] / f.shadow[2];
  return {clamp(along(0, f.shadow_size[0]) * per * texels, -most_u, most_u),
          clamp(along(1, f.shadow_size[1]) * per * texels, -most_v, most_v)};
}

/// At p with normal n; x, y are its pixel. Where `wanted` is nought anything may come out.
LANES F sunlight(const FrameData& f, const Maps& maps, const V3& p, const V3& n, const Slope& slope, I wanted, F x, F y) {
  if (maps.filter == 0) return all(1.0f);
  const int blockers = maps.filter == 2 ? 14 : 8, taps = maps.filter == 2 ? 24 : 12;
  const float texel = f.shadow[0] > f.shadow[1] ? f.shadow[0] : f.shadow[1];
  const V3 q = p + n * (1.5f * texel);
  const float* m = f.world_to_shadow;
  const F u = m[0] * q.x + m[4] * q.y + m[8] * q.z + m[12], v = m[1] * q.x + m[5] * q.y + m[9] * q.z + m[13];
  const F z = min(m[2] * q.x + m[6] * q.y + m[10] * q.z + m[14], 1.0f);

  const float side = static_cast<float>(maps.bounds_side);
  const I within = (u >= 0.0f) & (u < 1.0f) & (v >= 0.0f) & (v < 1.0f);
  const I block = clamp(to_int(saturate(v) * side), 0, maps.bounds_side - 1) * maps.bounds_side +
                  clamp(to_int(saturate(u) * side), 0, maps.bounds_side - 1);
  const F least = within ? gather(maps.bounds, block * 2) : all(1.0f);
  const F largest = within ? gather(maps.bounds, block * 2 + 1) : all(1.0f);
  const F plain = step(z, least);
  const I open = wanted & (z > least) & (z <= largest);
  if (!any(open)) return plain;

  const Lookup map{maps.depth, maps.depth_size + 2, static_cast<float>(maps.depth_size)};
  const F texel_u = u * map.size + 1.0f, texel_v = v * map.size + 1.0f;  // from the rim
  Spiral first{two(1, 0)};
  if (maps.filter == 2) {
    const F turn = pixel_noise(x, y);
    first = {{sine_of_turn(turn + 0.25f), sine_of_turn(turn)}};
  }
  Spiral at = first;
  const float wide_u = maps.reach / f.shadow[0], wide_v = maps.reach / f.shadow[1];  // [texels]
  F blocker = all(0.0f), found = all(0.0f);
  for (int i = 0; i < blockers; ++i, at.next()) {
    const float r = radius(i, blockers);
    const F du = at.d.x * (r * wide_u), dv = at.d.y * (r * wide_v);
    const F depth = depth_at(map, texel_u + du, texel_v + dv);
    const F hit = depth <= min(z + slope.u * du + slope.v * dv, 1.0f) - 0.0002f ? all(1.0f) : all(0.0f);
    blocker += depth * hit;
    found += hit;
  }
  const F lit = open ? step(found, all(0.5f)) : plain;
  const I edge = open & (found > 0.5f) & (found < static_cast<float>(blockers) - 0.5f);
  if (!any(edge)) return lit;

  const F gap = (z - blocker / max(found, 1.0f)) * f.shadow[2];
  const F spread = clamp(gap * kSunSpread, 1.2f * texel, maps.reach);
  const F spread_u = spread * (1 / f.shadow[0]), spread_v = spread * (1 / f.shadow[1]);
  at = first;
  F sum = all(0.0f);
  for (int i = 0; i < taps; ++i, at.next()) {
    const float r = radius(i, taps);
    const F du = at.d.x * r * spread_u, dv = at.d.y * r * spread_v;
    sum += nearer_than(map, texel_u - 0.5f + du, texel_v - 0.5f + dv, min(z + slope.u * du + slope.v * dv, 1.0f));
  }
  return edge ? sum * (1 / static_cast<float>(taps)) : lit;
}

}  // namespace
}  // namespace render::shade
