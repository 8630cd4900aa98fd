// Things: one material model for all, its numbers in a row of the material table.
// A kernel over what OpenGL saw (the visibility buffer): in GLSL this pass took 59 ms of a 1920x1080 frame (8255c0a), here 19.5
// (937bacc; one worker, follow camera, one run on one machine).
#pragma once

#include "render/shade/background.h"
#include "render/shade/kernels.h"

namespace render::shade {
namespace {

constexpr int kMaterialNumbers = 16;

/// The numbers of each lane's row.
struct MaterialRows {
  V3 base;
  F diffuse;                                       // share
  F straight, grazing, mirror, glow;               // reflection straight on and at grazing, tinted mirror
  F broad, broad_exponent, sharp, sharp_exponent;  // tinted and white highlight
  F wrap, sheen, grain, terrain;                   // terrain: 1 ground, -1 ribs of a lamp
};

/// What stands in each lane's record of `size` numbers from `from` on, of which eight are read; the loads of eight whole records
/// take a sixth of what as many gathers do.
LANES void records_at(const float* from, int size, I at, F* out) {
  F eight[kLanes];
  for (int i = 0; i < kLanes; ++i) eight[i] = load(from + static_cast<std::int64_t>(at[i]) * size);
  turn(eight);
  for (int k = 0; k < kLanes; ++k) out[k] = eight[k];
}

LANES MaterialRows rows_of(const float* table, I row) {
  F numbers[kMaterialNumbers];
  if (!any(row != row[0])) {  // mostly
    for (int k = 0; k < kMaterialNumbers; ++k) numbers[k] = all(table[row[0] * kMaterialNumbers + k]);
  } else {
    records_at(table, kMaterialNumbers, row, numbers);
    records_at(table + kLanes, kMaterialNumbers, row, numbers + kLanes);
  }
  MaterialRows out;
  static_assert(sizeof out == sizeof numbers);
  __builtin_memcpy(&out, numbers, sizeof out);
  return out;
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

/// What the corners of its triangle make of a surface.
struct Look {
  F depth;  // 0..1
  V3 normal;
  F grain;
  I inside;  // of a body
  MaterialRows material;
};

LANES V3 surface_light(const FrameData& f, const Maps& maps, bool terrain, const V3& p, const Look& look, F x, F y) {
  const V3& n = look.normal;
  const MaterialRows& m = look.material;
  const V3 to_sun = three(f.sun);
  const V3 v = f.eye[3] > 0.5f ? three(-f.forward[0], -f.forward[1], -f.forward[2]) : normalize(three(f.eye) - p);
  const F toward = dot(n, to_sun), ndl = max(toward, 0.0f), ndv = saturate(dot(n, v));
  const F lit = sunlight(f, maps, p, n, slope_of(f, maps, n), toward >= -m.wrap, x, y);
  const F height = p.z - f.ground[0];
  const V3 sky =
      ambient_light(f, n.z, mix(0.30f, 1.0f, smoothstep(0, 0.9f, height))) * mix(0.62f, 1.0f, smoothstep(-0.05f, 0.45f, height));
  const V3 r = n * (2.0f * dot(n, v)) - v;
  // a mirror close to the road sees the car's own shade under it
  const F shade = r.z >= 0.0f ? all(1.0f) : mix(0.35f, 1.0f, smoothstep(0, 0.8f, height));
  const V3 mirror = surroundings(f, r) * shade;
  const F away = 1.0f - ndv, fresnel = away * away * away * away * away;
  const F reflects = m.straight + m.grazing * fresnel;
  V3 paint = m.base * (1.0f + m.grain * (look.grain - 0.5f));
  if (terrain && any(m.terrain > 0.0f)) {
    const Footprint w = footprint(f, x, y, p, n);
    paint = mix(paint, ground_colour(f, maps, everything, p.x, p.y, w), max(m.terrain, 0.0f));
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
  c = {look.inside ? within.x : c.x, look.inside ? within.y : c.y, look.inside ? within.z : c.z};
  const F far_m = f.eye[3] > 0.5f ? all(0.0f) : length(p - three(f.eye));
  return to_screen(mix(c, haze_colour(f), haze_at(f, far_m)));
}

LANES F sine(F x) {
  return sine_of_turn(x * 0.15915494f);
}

/// The weave of cloth.
LANES F weave(const V3& p) {
  return 0.5f + 0.25f * sine(p.x * 31.0f + 2.0f * sine(p.z * 23.0f)) * sine(p.y * 37.0f + 2.0f * sine(p.x * 17.0f + p.z * 9.0f));
}

struct Weights {
  F of[3];
};

enum class Reach { within, beyond };  // a middle of samples may lie a little beside its triangle; what changes from it on does

/// The corners of each lane's triangle.
struct TriangleCorners {
  I v[3];
  F px[3], py[3], depth[3], w[3], scale[3];
  V3 normal[3];

  LANES TriangleCorners(const Scene& s, const F* words) : v{} {
    for (int k = 0; k < 3; ++k) {
      v[k] = reinterpret_cast<const I&>(words[k]);
      F record[kLanes];
      records_at(s.corners.records, kLanes, v[k], record);
      px[k] = record[0];
      py[k] = record[1];
      depth[k] = record[2];
      w[k] = record[3];
      scale[k] = record[4];
      normal[k] = {record[5], record[6], record[7]};
    }
  }

  /// Weights of the scaled corners at a place of the picture, not normalised: a point of the triangle is the sum of its corners by
  /// their weights, in clip space.
  LANES Weights weigh(F x, F y, Reach reach) const {
    F rx[3], ry[3];
    for (int k = 0; k < 3; ++k) {
      rx[k] = px[k] - x * w[k];
      ry[k] = py[k] - y * w[k];
    }
    Weights out{{rx[1] * ry[2] - ry[1] * rx[2], rx[2] * ry[0] - ry[2] * rx[0], rx[0] * ry[1] - ry[0] * rx[1]}};
    const I turned = (out.of[0] + out.of[1] + out.of[2]) < 0.0f;  // a back face runs the other way round
    for (F& each : out.of) {
      each = turned ? -each : each;
      if (reach == Reach::within) each = max(each, 0.0f);
    }
    return out;
  }

  /// Those of the corners where they are on the body, which sum to one.
  LANES Weights place(Weights weights) const {
    for (int k = 0; k < 3; ++k) weights.of[k] *= scale[k];
    const F per = 1.0f / max(weights.of[0] + weights.of[1] + weights.of[2], 1e-30f);
    for (F& each : weights.of) each = each * per;
    return weights;
  }

  /// Mean of one of the numbers that stand beside the corners.
  LANES F blend(const Scene& s, int number, const Weights& by) const {
    const float* values = s.corners.places + number;
    return gather(values, v[0] * 4) * by.of[0] + gather(values, v[1] * 4) * by.of[1] + gather(values, v[2] * 4) * by.of[2];
  }
};

/// The normal of a lamp's reflector under clear plastic, the mean of the pixel's samples; sx, sy count samples.
LANES V3 ribbed_normal(const Scene& s, const TriangleCorners& corners, const Weights& by, F sx, F sy, const V3& smooth) {
  const auto point = [&](const Weights& weight) { return V2{corners.blend(s, 1, weight), corners.blend(s, 2, weight)}; };
  const V2 p = point(by), right = point(corners.place(corners.weigh(sx + 1.0f, sy, Reach::beyond))),
           up = point(corners.place(corners.weigh(sx, sy + 1.0f, Reach::beyond)));
  const V2 dx = {right.x - p.x, right.y - p.y}, dy = {up.x - p.x, up.y - p.y};
  const F change = 25.0f * (abs(dx.x) + abs(dy.x)) + 20.0f * (abs(dx.y) + abs(dy.y));
  const F deep = 0.25f * (1.0f - smoothstep(0.2f, 0.8f, change));
  F ribs_y = all(0.0f), ribs_z = all(0.0f);
  const int many = s.samples > 1 ? 2 : 1;
  for (int k = 0; k < many * many; ++k) {
    const int across = k % many, down = k / many;
    const float i = static_cast<float>(across) - 0.5f * static_cast<float>(many - 1),
                j = static_cast<float>(down) - 0.5f * static_cast<float>(many - 1);
    ribs_y += sine((p.x + dx.x * i + dy.x * j) * 160.0f);
    ribs_z += sine((p.y + dx.y * i + dy.y * j) * 130.0f + 1.57079633f);
  }
  const F share = deep * (1 / static_cast<float>(many * many));
  return normalize({smooth.x, smooth.y + share * ribs_y, smooth.z + share * ribs_z});
}

LANES Look look_of(const Scene& s, const float* materials, I triangle, F x, F y) {
  constexpr int kWords = sizeof(Triangle) / sizeof(float);
  F words[kLanes];
  records_at(reinterpret_cast<const float*>(s.triangles), kWords, triangle, words);
  const I row = reinterpret_cast<I>(words[3]);
  const F side = words[5];
  const TriangleCorners corners(s, words);
  const F sx = x * s.samples, sy = y * s.samples;
  const Weights flat = corners.weigh(sx, sy, Reach::within), by = corners.place(flat);
  const auto mean = [&flat](const F* of) { return of[0] * flat.of[0] + of[1] * flat.of[1] + of[2] * flat.of[2]; };
  const V3* normal = corners.normal;
  Look out{mean(corners.depth) / max(mean(corners.w), 1e-30f), normal[0] * by.of[0] + normal[1] * by.of[1] + normal[2] * by.of[2],
           all(0.5f), row >= 32768, rows_of(materials, row & 32767)};
  const F length2 = dot(out.normal, out.normal);
  out.normal = out.normal * (side / sqrt(max(length2, 1e-20f)));
  const I ribbed = out.material.terrain<0.0f, woven = out.material.grain> 0.0f;
  if (any(woven)) {
    const V3 p{corners.blend(s, 0, by), corners.blend(s, 1, by), corners.blend(s, 2, by)};
    out.grain = woven ? weave(p) : out.grain;
  }
  if (any(ribbed)) {
    const V3 n = ribbed_normal(s, corners, by, sx, sy, out.normal);
    out.normal = {ribbed ? n.x : out.normal.x, ribbed ? n.y : out.normal.y, ribbed ? n.z : out.normal.z};
  }
  return out;
}

void surfaces(const FrameData& frame, const Maps& all_maps, const Scene& scene, const Surfaces& seen) {
  const FrameData f = frame;
  const Maps maps = all_maps;
  const Scene s = scene;
  const Surfaces list = seen;
  for (int i = 0; i < list.count; i += kLanes) {
    const F x = load(list.x + i), y = load(list.y + i);
    const Look look = look_of(s, s.materials, load_int(list.triangle + i), x, y);
    const V3 p = place_of(f, x, y, look.depth);
    const V3 c = surface_light(f, maps, s.terrain, p, look, x, y);
    store(c.x, list.red + i);
    store(c.y, list.green + i);
    store(c.z, list.blue + i);
  }
}

}  // namespace
}  // namespace render::shade
