// The ground: asphalt with grain and markings, pavement, grass, a grid; everything filtered over the pixel's footprint.
#pragma once

#include "render/shade/shadow.h"

namespace render::shade {
namespace {

enum Ground : int { sky, everything, roadway, asphalt, pavement, grass };  // as enum Zone
enum Sunshine : int { bare, lit, dark, open };                             // as enum Sun

/// A footprint along one axis, and one over it.
struct Width {
  F w, per;
};
struct Footprint {
  Width x, y;
};
LANES Footprint footprint(F x, F y) {
  return {{x, 1.0f / x}, {y, 1.0f / y}};
}

/// Part of a footprint around x that a bar of half width h at c covers.
LANES F bar(F x, float c, float h, const Width& w) {
  return saturate((min(x + 0.5f * w.w, c + h) - max(x - 0.5f * w.w, c - h)) * w.per);
}

/// The same for bars repeated with a period, exact for any footprint.
LANES F bars(F x, float period, float h, const Width& w) {
  const float r = h / period;
  const F a = (x - 0.5f * w.w) * (1 / period), b = (x + 0.5f * w.w) * (1 / period);
  const F na = floor(a + 0.5f), nb = floor(b + 0.5f);
  const F ia = na * (2 * r) + clamp(a - na, -r, r), ib = nb * (2 * r) + clamp(b - nb, -r, r);
  return saturate((ib - ia) * period * w.per);
}

/// Grain of a tile, gone to its mean where the footprint passes its texels: the next coarser layer takes over.
LANES F grain(const Maps& maps, F x, F y, float tile, F size) {
  const F weight = saturate(1.4f - size * (0.4f * 256 / tile));
  if (!any(weight > 0.0f)) return all(0.0f);
  const F u = x * (256 / tile) - 0.5f, v = y * (256 / tile) - 0.5f;
  const F i = floor(u), j = floor(v), s = u - i, t = v - j;
  const I four = gather(maps.grain, ((to_int(j) & 255) << 8) | (to_int(i) & 255));
  const F a = to_float(four & 255), b = to_float((four >> 8) & 255), c = to_float((four >> 16) & 255),
          d = to_float((four >> 24) & 255);
  return (mix(mix(a, b, s), mix(c, d, s), t) * (1 / 255.0f) - 0.5f) * weight;
}

struct Grain {
  F fine, middle, wide;
};

LANES V3 grey(float r, float g, float b, F s) {
  return {r * s, g * s, b * s};
}

LANES V3 grass_colour(const Grain& g) {
  return mix(three(0.085f, 0.110f, 0.045f), three(0.135f, 0.145f, 0.065f), saturate(0.5f + 1.8f * g.wide + g.middle)) *
         (1.0f + 1.5f * g.fine + 0.5f * g.middle);
}

LANES V3 pavement_colour(F x, F y, const Footprint& w, const Grain& g) {
  const F joint = max(bars(x, 0.6f, 0.005f, w.x), bars(y, 0.6f, 0.005f, w.y));
  return grey(0.215f, 0.21f, 0.2f, (1.0f + 0.45f * g.fine + 0.15f * g.middle + 0.25f * g.wide) * (1.0f - 0.4f * joint));
}

LANES V3 paint_markings(const FrameData& f, const V3& road, F x, F y, float lane, const Footprint& w, const Grain& g) {
  const float half = f.ground[1];
  F paint = bar(abs(y), half - 0.25f, 0.06f, w.y);
  const int lanes = static_cast<int>(f.ground[3]);
  if (lanes > 1) {
    const F broken = bars(x, 9, 1.5f, w.x);
    for (int i = 1; i < lanes; ++i) paint = max(paint, broken * bar(y, -half + lane * static_cast<float>(i), 0.06f, w.y));
  }
  if (f.road[2] > 0.5f) {  // zebra
    const F inside = bar(y, 0, half - 0.45f, w.y), clear = 1.0f - bar(x, f.road[3], 2.4f, w.x);
    paint = max(paint * clear, inside * bar(x, f.road[3], 1.75f, w.x) * bars(y, 1, 0.25f, w.y));
  }
  const V3 white = grey(0.62f, 0.62f, 0.60f, 0.93f + 0.55f * g.fine + 0.18f * g.middle);
  return mix(road, white, paint * saturate(1.02f + 0.7f * g.middle));
}

LANES V3 road_colour(const FrameData& f, int zone, F x, F y, const Footprint& w, const Grain& g) {
  V3 c = grey(0.118f, 0.117f, 0.118f, 1.0f + 0.95f * g.fine + 0.55f * g.middle + 0.40f * g.wide);
  // wheels polish two tracks in each lane
  const float half = f.ground[1], lane = 2 * half / (f.ground[3] > 1 ? f.ground[3] : 1);
  const F track = abs(abs(fract((y + half) * (1 / lane)) - 0.5f) * lane - 0.75f);
  c = c * (1.0f + 0.07f * (1.0f - smoothstep(0.1f, 0.5f, track)) - 0.03f);
  if (zone != asphalt) c = paint_markings(f, c, x, y, lane, w, g);
  if (zone != everything) return c;
  // kerb stone, pavement of slabs, grass
  const F off = abs(y) - half;
  c = mix(c, grey(0.25f, 0.245f, 0.235f, 1.0f + 0.4f * g.middle + 0.3f * g.fine), saturate(off * w.y.per + 0.5f));
  c = mix(c, pavement_colour(x, y, w, g), saturate((off - 0.15f) * w.y.per + 0.5f));
  return mix(c, grass_colour(g), saturate((off - 2.15f - 0.1f * (g.middle + g.fine)) * min(w.y.per, 50.0f) + 0.5f));
}

/// Straight from the screen's curve to light, to 2 %.
LANES F from_screen(F c) {
  return c * (c * (c * 0.305306011f + 0.682171111f) + 0.012522878f);
}

/// The photograph over what else the ground is, where it lies; between the two levels whose texels come near the footprint.
LANES V3 over_photograph(const Photograph& p, const V3& ground, F x, F y, const Footprint& w) {
  const F dx = x - p.x, dy = y - p.y;
  const F u = (dx * p.cosine + dy * p.sine) * (1 / p.texel), v = (dy * p.cosine - dx * p.sine) * (1 / p.texel);  // [texels]
  const I inside = (u >= 0.0f) & (v >= 0.0f) & (u < static_cast<float>(p.width[0])) & (v < static_cast<float>(p.height[0]));
  if (!any(inside)) return ground;
  const F level = clamp(log2(max(0.5f * (w.x.w + w.y.w) * (1 / p.texel), 1.0f)), 0, static_cast<float>(p.levels - 1));
  V3 sum = three(0, 0, 0);
  F cover = all(0.0f);
  for (int l = 0; l < p.levels; ++l) {
    const F weight = inside ? saturate(1.0f - abs(level - static_cast<float>(l))) : all(0.0f);
    if (!any(weight > 0.0f)) continue;
    const float scale = 1 / static_cast<float>(1 << l);
    const F a = u * scale - 0.5f, b = v * scale - 0.5f, i = floor(a), j = floor(b), s = a - i, t = b - j;
    for (int corner = 0; corner < 4; ++corner) {
      const int right = corner & 1, up = corner >> 1;
      const I at = clamp(to_int(j) + up, 0, p.height[l] - 1) * p.width[l] + clamp(to_int(i) + right, 0, p.width[l] - 1);
      const I texel = gather(p.texels[l], at);
      const F share = weight * (right ? s : 1.0f - s) * (up ? t : 1.0f - t);
      const auto channel = [&](int shift) { return to_float((texel >> shift) & 255) * (1 / 255.0f); };
      const F opaque = share * channel(24);
      cover += opaque;
      sum = sum + V3{from_screen(channel(0)), from_screen(channel(8)), from_screen(channel(16))} * opaque;
    }
  }
  // a photograph has the light of its day in it: about twice what the ground itself reflects
  return ground * (1.0f - cover) + sum * 0.5f;
}

/// Colour of the ground at x, y, filtered over the footprint w.
LANES V3 ground_colour(const FrameData& f, const Maps& maps, int zone, F x, F y, const Footprint& w) {
  const F size = 0.7f * max(w.x.w, w.y.w);
  const Grain g{grain(maps, x, y, 1.07f, size), grain(maps, x + 3.7f, y + 1.3f, 6.3f, size),
                grain(maps, y + 11.0f, x + 5.0f, 41.0f, size)};
  const F across = y - f.ground[2];
  const bool road = f.road[0] > 0.5f;
  V3 c;
  if (zone == grass)
    c = grass_colour(g);
  else if (zone == pavement)
    c = pavement_colour(x, across, w, g);
  else if (road)
    c = road_colour(f, zone, x, across, w, g);
  else
    c = grey(0.165f, 0.165f, 0.168f, 1.0f + 0.7f * g.fine + 0.45f * g.middle + 0.30f * g.wide);
  if (zone == everything && (!road || f.road[1] > 0.5f)) {  // a metre grid
    const F line = max(bars(x, 1, 0.008f, w.x), bars(y, 1, 0.008f, w.y));
    c = mix(c, three(0.42f, 0.42f, 0.42f), 0.55f * line);
  }
  if (maps.photograph.levels > 0 && zone == everything) c = over_photograph(maps.photograph, c, x, y, w);
  return max(c, 0.005f);
}

/// How much of the sky things near x, y leave open, from the map.
LANES F open_sky(const FrameData& f, const Maps& maps, F x, F y) {
  const float n = static_cast<float>(maps.occlusion_size);
  const F u = clamp((x - f.occlusion[0]) * (n / f.occlusion[2]) - 0.5f, -1, n);
  const F v = clamp((y - f.occlusion[1]) * (n / f.occlusion[3]) - 0.5f, -1, n);
  const F i = floor(u), j = floor(v), s = u - i, t = v - j;
  const int pitch = maps.occlusion_size + 2;
  const auto at = [&](int a, int b) {
    return gather(maps.occlusion,
                  (clamp(to_int(j) + b, -1, maps.occlusion_size) + 1) * pitch + clamp(to_int(i) + a, -1, maps.occlusion_size) + 1);
  };
  return mix(mix(at(0, 0), at(1, 0), s), mix(at(0, 1), at(1, 1), s), t);
}

/// A pixel's ray and how it changes from pixel to pixel.
struct Ray {
  V3 from, along;
  V3 from_x, along_x, from_y, along_y;
};
LANES Ray ray_of(const FrameData& f, F x, F y) {
  const V3 near_x = three(f.near_x), near_y = three(f.near_y), far_x = three(f.far_x), far_y = three(f.far_y);
  const V3 from = three(f.near_0) + near_x * x + near_y * y, to = three(f.far_0) + far_x * x + far_y * y;
  return {from, to - from, near_x, far_x - near_x, near_y, far_y - near_y};
}

/// How far before the ray's first point the eye lies, in lengths of the ray; the same for all rays of a perspective picture.
LANES float before_ray(const FrameData& f) {
  float before = 0, along = 0;
  for (int i = 0; i < 3; ++i) {
    before += (f.near_0[i] - f.eye[i]) * f.forward[i];
    along += (f.far_0[i] - f.near_0[i]) * f.forward[i];
  }
  return before / along;
}

LANES V3 ground_light(const FrameData& f, const Maps& maps, const Tile& tile, F x, F y) {
  const Ray ray = ray_of(f, x, y);
  const F reach = sqrt(dot(ray.along, ray.along));  // [m] between the two points that make the ray
  const V3 d = ray.along * (1.0f / reach);
  // where the ray meets the ground, and how far that moves from pixel to pixel; behind or beside the horizon: very far
  const F per_fall = -1.0f / min(ray.along.z, -1e-6f);
  const F s = min((ray.from.z - f.ground[0]) * per_fall, 1e5f);
  const V3 p{ray.from.x + s * ray.along.x, ray.from.y + s * ray.along.y, all(f.ground[0])};
  const V3 along_x = ray.from_x + ray.along_x * s, along_y = ray.from_y + ray.along_y * s;
  const F step_x = along_x.z * per_fall, step_y = along_y.z * per_fall;
  const Footprint w = footprint(clamp(abs(along_x.x + ray.along.x * step_x) + abs(along_y.x + ray.along.x * step_y), 1e-4f, 1e4f),
                                clamp(abs(along_x.y + ray.along.y * step_x) + abs(along_y.y + ray.along.y * step_y), 1e-4f, 1e4f));
  V3 c = ground_colour(f, maps, tile.zone, p.x, p.y, w);
  F sky_open = all(1.0f), lit = all(1.0f);
  if (tile.sun != bare) {
    sky_open = open_sky(f, maps, p.x, p.y);
    if (tile.sun == dark) lit = all(0.0f);
    if (tile.sun == open) lit = sunlight(f, maps, p, three(0, 0, 1), {all(0.0f), all(0.0f)}, all(-1), x, y);
  }
  const F sun = (f.sun[2] > 0 ? f.sun[2] : 0.0f) * lit * mix(sky_open, all(1.0f), all(0.6f));
  c = c * (three(kSunLight) * sun + ambient_light(f, all(1.0f), all(1.0f)) * sky_open);
  const F far_m = f.eye[3] > 0.5f ? all(0.0f) : (s + before_ray(f)) * reach;
  // asphalt shines a little against the light
  const F steep = 1.0f - saturate(-d.z);
  c = c + haze_colour(f) * (0.05f * (1.0f - f.eye[3]) * steep * steep * steep * steep * steep * sky_open);
  if (tile.near_ground) return to_screen(mix(c, haze_colour(f), haze_at(f, far_m)));
  // at the very horizon ground and sky are one haze; the sun's glow fades in with distance
  const F horizon = smoothstep(150, 900, far_m);
  const V3 above = sky_light(f, {d.x, d.y, max(d.z, 0.0f)});
  c = mix(mix(c, haze_colour(f), mix(haze_at(f, far_m), all(1.0f), horizon)), above, horizon);
  return to_screen(mix(above, c, step(all(1e-5f), -d.z))) + dither(x, y);
}

void background(const FrameData& frame, const Maps& all_maps, const Tile& one, const Canvas& out) {
  // copies of its own: a pixel written cannot change them, and what follows from them is computed once
  const FrameData f = frame;
  const Maps maps = all_maps;
  const Tile tile = one;
  for (int row = tile.y; row < tile.y + tile.height; ++row) {
    std::uint8_t* at = out.pixels + 4 * (static_cast<std::int64_t>(row) * out.width + tile.x);
    const F y = all(static_cast<float>(row) + 0.5f);
    for (int i = 0; i < tile.width; i += kLanes, at += 4 * kLanes) {
      const F x = count_up(static_cast<float>(tile.x + i) + 0.5f);
      const int count = tile.width - i < kLanes ? tile.width - i : kLanes;
      if (tile.covered) {
        std::uint64_t bytes = 0;
        __builtin_memcpy(&bytes, tile.covered + static_cast<std::int64_t>(row) * out.width + tile.x + i, sizeof bytes);
        if (bytes == ~std::uint64_t{0}) continue;
      }
      if (tile.zone == sky)
        put(to_screen(sky_light(f, normalize(ray_of(f, x, y).along))) + dither(x, y), count, at);
      else
        put(ground_light(f, maps, tile, x, y), count, at);
    }
  }
}

void occlusion(const FrameData& frame, const Occluders& o, int size, float* out) {
  const FrameData f = frame;
  const int pitch = size + 2;
  for (int i = 0; i < pitch * pitch; ++i) out[i] = 1;
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; i += kLanes) {
      const V3 p{f.occlusion[0] + f.occlusion[2] / static_cast<float>(size) * count_up(static_cast<float>(i) + 0.5f),
                 all(f.occlusion[1] + f.occlusion[3] / static_cast<float>(size) * (static_cast<float>(j) + 0.5f)),
                 all(f.ground[0])};
      const auto row = [&p](const float* r) { return r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3]; };
      F left = all(1.0f);
      for (int k = 0; k < o.rounds; ++k) {
        const float* r = o.round_rows + 12 * k;
        const V3 u{row(r), row(r + 4), row(r + 8)};
        // the up direction in the sphere's own space; cosine to the centre over squared distance is the form factor
        const V3 up = normalize(three(r[2], r[6], r[10]));
        const F d2 = max(dot(u, u), 1.0f), cosine = max(-dot(u, up) / sqrt(d2), 0.0f);
        left *= 1.0f - 0.9f * cosine / d2;
      }
      for (int k = 0; k < o.boxes; ++k) {
        const float *r = o.box_rows + 12 * k, *h = o.box_half + 4 * k;
        const V3 b{row(r), row(r + 4), row(r + 8)};
        const float least = h[0] < h[1] ? h[0] : h[1], rounding = least < 0.45f ? least : 0.45f;
        const F bx = max(abs(b.x) - (h[0] - rounding), 0.0f), by = max(abs(b.y) - (h[1] - rounding), 0.0f);
        const F side = max(sqrt(bx * bx + by * by) - rounding, -0.3f), under = max(abs(b.z) - h[2], 0.0f);
        left *= 1.0f - 0.86f * min(exp((side + 0.12f) * (-1 / 0.28f)), 1.0f) / (1.0f + under * under * 4.0f);
      }
      __builtin_memcpy(out + (j + 1) * pitch + i + 1, &left, sizeof left);
    }
}

}  // namespace
}  // namespace render::shade
