// Things: one material model for all, its numbers in a row of the material table.
#pragma once

#include "render/shade/ground.h"

namespace render::shade {
namespace {

/// Sixteen numbers of each lane's row.
struct MaterialRows {
  V3 base;
  F diffuse;                                       // share
  F straight, grazing, mirror, glow;               // reflection straight on and at grazing, tinted mirror
  F broad, broad_exponent, sharp, sharp_exponent;  // tinted and white highlight
  F wrap, sheen, grain, terrain;
};
LANES MaterialRows rows_of(const float* table, I row) {
  const I at = row * 16;
  const bool one = !any(row != row[0]);  // mostly
  const float* only = table + at[0];
  const auto n = [&](int i) { return one ? all(only[i]) : gather(table + i, at); };
  return {{n(0), n(1), n(2)}, n(3), n(4), n(5), n(6), n(7), n(8), n(9), n(10), n(11), n(12), n(13), n(14), n(15)};
}

LANES V3 normal_of(F u, F v) {
  u = u * 2.0f - 1.0f;
  v = v * 2.0f - 1.0f;
  const F z = 1.0f - abs(u) - abs(v), t = max(-z, 0.0f);
  return normalize({u + (u < 0.0f ? t : -t), v + (v < 0.0f ? t : -t), z});
}

LANES V3 place_of(const FrameData& f, F x, F y, F depth) {
  const float* m = f.clip_to_world;
  const F cx = x * f.frame[0] - 1.0f, cy = y * f.frame[1] - 1.0f, cz = depth * 2.0f - 1.0f;
  const auto row = [&](int i) { return m[i] * cx + m[4 + i] * cy + m[8 + i] * cz + m[12 + i]; };
  const F per_w = 1.0f / row(3);
  return {row(0) * per_w, row(1) * per_w, row(2) * per_w};
}

/// Size of a pixel on the plane through p with normal n, along the world's x and y.
LANES Footprint footprint(const FrameData& f, F x, F y, const V3& p, const V3& n) {
  const Ray ray = ray_of(f, x, y);
  const F s = sqrt(dot(p - ray.from, p - ray.from) / dot(ray.along, ray.along));
  const F steep = dot(n, ray.along), per = 1.0f / (abs(steep) > 1e-6f ? steep : all(-1e-6f));
  const V3 ax = ray.from_x + ray.along_x * s, ay = ray.from_y + ray.along_y * s;
  const V3 dx = ax - ray.along * (dot(n, ax) * per), dy = ay - ray.along * (dot(n, ay) * per);
  return footprint(clamp(abs(dx.x) + abs(dy.x), 1e-4f, 1e3f), clamp(abs(dx.y) + abs(dy.y), 1e-4f, 1e3f));
}

/// Highlight of the sun, Blinn-Phong normalised.
LANES F shine(F cosine, F exponent) {
  return (exponent + 8.0f) * (1 / 25.13f) * pow(cosine, exponent);
}

LANES V3 surface_light(const FrameData& f, const Maps& maps, const float* materials, bool terrain, const V3& p, const V3& n, I id,
                       F grain, F x, F y) {
  const I inside = id >= 32768;
  const MaterialRows m = rows_of(materials, inside ? id - 32768 : id);
  const V3 to_sun = three(f.sun);
  const V3 v = f.eye[3] > 0.5f ? three(-f.forward[0], -f.forward[1], -f.forward[2]) : normalize(three(f.eye) - p);
  const F toward = dot(n, to_sun), ndl = max(toward, 0.0f), ndv = saturate(dot(n, v));
  const F lit = sunlight(f, maps, p, n, toward >= -m.wrap, x, y);
  const F height = p.z - f.ground[0];
  const V3 sky =
      ambient_light(f, n.z, mix(0.30f, 1.0f, smoothstep(0, 0.9f, height))) * mix(0.62f, 1.0f, smoothstep(-0.05f, 0.45f, height));
  const V3 r = n * (2.0f * dot(n, v)) - v;
  // a mirror close to the road sees the car's own shade under it
  const F shade = r.z >= 0.0f ? all(1.0f) : mix(0.35f, 1.0f, smoothstep(0, 0.8f, height));
  const V3 mirror = surroundings(f, r) * shade;
  const F away = 1.0f - ndv, fresnel = away * away * away * away * away;
  const F reflects = m.straight + m.grazing * fresnel;
  V3 paint = m.base * (1.0f + m.grain * (grain - 0.5f));
  if (terrain && any(m.terrain > 0.0f)) {
    const Footprint w = footprint(f, x, y, p, n);
    paint = mix(paint, ground_colour(f, maps, everything, p.x, p.y, w), m.terrain);
  }
  // light goes a little way round into skin and comes out warmer
  const F wrapped = m.wrap > 0.001f ? max((toward + m.wrap) / (1.0f + m.wrap), 0.0f) : ndl;
  const V3 sunny{kSunLight[0] * wrapped * lit, kSunLight[1] * mix(ndl, wrapped, all(0.45f)) * lit,
                 kSunLight[2] * mix(ndl, wrapped, all(0.3f)) * lit};
  V3 c = paint * ((sunny + sky) * (m.diffuse * (1.0f - reflects)) + sky * (m.sheen * fresnel) + mirror * m.mirror + m.glow);
  const F half_cosine = max(dot(n, normalize(to_sun + v)), 0.0f);
  c = c + mirror * reflects;
  const F sun = lit * ndl;
  if (any(sun > 0.0f)) {
    const F sharp = m.sharp * shine(half_cosine, m.sharp_exponent);
    c = c + three(kSunLight) * (paint * (m.broad * shine(half_cosine, m.broad_exponent)) + sharp) * sun;
  }
  const V3 within = paint * sky * 0.25f + all(0.006f);
  c = {inside ? within.x : c.x, inside ? within.y : c.y, inside ? within.z : c.z};
  const F far_m = f.eye[3] > 0.5f ? all(0.0f) : length(p - three(f.eye));
  return to_screen(mix(c, haze_colour(f), haze_at(f, far_m)));
}

LANES F load(const float* from) {
  F v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}

void surfaces(const FrameData& frame, const Maps& all_maps, const float* materials, bool terrain, const Pieces& pieces) {
  const FrameData f = frame;
  const Maps maps = all_maps;
  const Pieces list = pieces;
  for (int i = 0; i < list.count; i += kLanes) {
    const F x = load(list.x + i), y = load(list.y + i);
    I row;
    __builtin_memcpy(&row, list.row + i, sizeof row);
    const V3 p = place_of(f, x, y, load(list.depth + i)), n = normal_of(load(list.u + i), load(list.v + i));
    const V3 c = surface_light(f, maps, materials, terrain, p, n, row, load(list.grain + i), x, y);
    __builtin_memcpy(list.red + i, &c.x, sizeof c.x);
    __builtin_memcpy(list.green + i, &c.y, sizeof c.y);
    __builtin_memcpy(list.blue + i, &c.z, sizeof c.z);
  }
}

}  // namespace
}  // namespace render::shade
