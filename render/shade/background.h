// The background: rays to ground and sky, their light, rows of pixels. What changes slowly along a row is computed for every eighth
// pixel of it and blended between. In GLSL sky, ground and marks took 68 ms of a 1920x1080 frame (8255c0a), the kernel 20.2
// (937bacc; one worker, follow camera, one run on one machine).
#pragma once

#include "render/shade/ground.h"

namespace render::shade {
namespace {

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
/// Those of a row of pixels: linear in x.
LANES Ray rays_of_row(const FrameData& f, F y) {
  const V3 near_x = three(f.near_x), near_y = three(f.near_y), far_x = three(f.far_x), far_y = three(f.far_y);
  const V3 from = three(f.near_0) + near_y * y, to = three(f.far_0) + far_y * y;
  return {from, to - from, near_x, far_x - near_x, near_y, far_y - near_y};
}
LANES Ray ray_at(const Ray& row, F x) {
  return {row.from + row.from_x * x, row.along + row.along_x * x, row.from_x, row.along_x, row.from_y, row.along_y};
}
LANES Ray ray_of(const FrameData& f, F x, F y) {
  return ray_at(rays_of_row(f, y), x);
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

/// Where a ray meets the ground; behind or beside the horizon: very far.
struct Meeting {
  F per_fall, s;  // one over the ray's descent; in lengths of the ray
  V3 p;
};
LANES Meeting meet(const FrameData& f, const Ray& ray) {
  const F per_fall = -1.0f / min(ray.along.z, -1e-6f);
  const F s = min((ray.from.z - f.ground[0]) * per_fall, 1e5f);
  return {per_fall, s, {ray.from.x + s * ray.along.x, ray.from.y + s * ray.along.y, all(f.ground[0])}};
}

/// What changes so little along a row that every eighth pixel tells it.
struct Air {
  F clear;             // part of the ground's light that comes through the haze
  F shine;             // asphalt shines a little against the light: how much of the haze's colour it sends
  F width_x, width_y;  // how far the meeting point moves from pixel to pixel
  F far_m;
};
LANES Air air_of(const FrameData& f, const Ray& ray, const Meeting& at) {
  const V3 along_x = ray.from_x + ray.along_x * at.s, along_y = ray.from_y + ray.along_y * at.s;
  const F step_x = along_x.z * at.per_fall, step_y = along_y.z * at.per_fall;
  const F reach = sqrt(dot(ray.along, ray.along));  // [m] between the two points that make the ray
  const F far_m = f.eye[3] > 0.5f ? all(0.0f) : (at.s + before_ray(f)) * reach;
  const F clear = 1.0f - haze_at(f, far_m);
  const F steep = 1.0f - saturate(-ray.along.z * (1.0f / reach)), steep2 = steep * steep;
  return {clear, (0.05f * (1.0f - f.eye[3])) * steep2 * steep2 * steep * clear,
          clamp(abs(along_x.x + ray.along.x * step_x) + abs(along_y.x + ray.along.x * step_y), 1e-4f, 1e4f),
          clamp(abs(along_x.y + ray.along.y * step_x) + abs(along_y.y + ray.along.y * step_y), 1e-4f, 1e4f), far_m};
}

/// Light of the ground at p, without the horizon's haze.
LANES V3 ground_light(const FrameData& f, const Maps& maps, const Tile& tile, const V3& p, const Air& air, F x, F y) {
  const V3 c = ground_colour(f, maps, tile.zone, p.x, p.y, footprint(air.width_x, air.width_y));
  const float sun = f.sun[2] > 0 ? f.sun[2] : 0.0f;
  const V3 haze = haze_colour(f), sky = ambient_light(f, all(1.0f), all(1.0f));
  if (tile.sun == bare) return c * (three(kSunLight) * sun + sky) * air.clear + haze * (air.shine + (1.0f - air.clear));
  const F sky_open = open_sky(f, maps, p.x, p.y);
  F lit = all(tile.sun == dark ? 0.0f : 1.0f);
  if (tile.sun == open) lit = sunlight(f, maps, p, three(0, 0, 1), {all(0.0f), all(0.0f)}, all(-1), x, y);
  const F sunny = sun * lit * mix(sky_open, all(1.0f), all(0.6f));
  return c * ((three(kSunLight) * sunny + sky * sky_open) * air.clear) + haze * (air.shine * sky_open + (1.0f - air.clear));
}

/// At the very horizon ground and sky are one haze; the sun's glow fades in with distance.
LANES V3 with_horizon(const FrameData& f, const V3& c, const Ray& ray, F far_m) {
  const V3 d = normalize(ray.along);
  const F horizon = smoothstep(150, 900, far_m);
  const V3 above = sky_light(f, {d.x, d.y, max(d.z, 0.0f)});
  return mix(above, mix(mix(c, haze_colour(f), horizon), above, horizon), step(all(1e-5f), -d.z));
}

/// A value at the first of eight pixels, eight times in a row, and how it goes on to the next first.
struct Course {
  float from[kLanes], more[kLanes];
};
LANES Course course(F from, F to) {
  Course out;
  const F more = to - from;
  __builtin_memcpy(out.from, &from, sizeof from);
  __builtin_memcpy(out.more, &more, sizeof more);
  return out;
}
LANES F along(const Course& c, int eight) {
  return c.from[eight] + c.more[eight] * count_up(0) * (1.0f / kLanes);
}

struct Span {
  int x, y, count;  // pixels, at most 64
  std::uint8_t* out;
  const std::uint8_t* covered;
};
/// Calls what shades eight pixels, where they can be seen.
template <class Eight>
LANES void each_eight(const Span& span, Eight eight) {
  for (int k = 0; k * kLanes < span.count; ++k) {
    if (span.covered) {
      std::uint64_t bytes = 0;
      __builtin_memcpy(&bytes, span.covered + k * kLanes, sizeof bytes);
      if (bytes == ~std::uint64_t{0}) continue;
    }
    const int left = span.count - k * kLanes;
    put(eight(k, count_up(static_cast<float>(span.x + k * kLanes) + 0.5f)), left < kLanes ? left : kLanes,
        span.out + 4 * k * kLanes);
  }
}

LANES void sky_span(const FrameData& f, const Ray& row, const Span& span) {
  const auto colour = [&](F x) { return to_screen(sky_light(f, normalize(ray_at(row, x).along))); };
  const F firsts = count_up(0) * kLanes + (static_cast<float>(span.x) + 0.5f), y = all(static_cast<float>(span.y) + 0.5f);
  const V3 from = colour(firsts), to = colour(firsts + kLanes);
  const Course red = course(from.x, to.x), green = course(from.y, to.y), blue = course(from.z, to.z);
  each_eight(span, [&](int k, F x) LANES_BODY { return V3{along(red, k), along(green, k), along(blue, k)} + dither(x, y); });
}

LANES void near_span(const FrameData& f, const Maps& maps, const Tile& tile, const Ray& row, const Span& span) {
  const auto air_at = [&](F x) {
    const Ray ray = ray_at(row, x);
    return air_of(f, ray, meet(f, ray));
  };
  const F firsts = count_up(0) * kLanes + (static_cast<float>(span.x) + 0.5f), y = all(static_cast<float>(span.y) + 0.5f);
  const Air from = air_at(firsts), to = air_at(firsts + kLanes);
  const Course clear = course(from.clear, to.clear), shine = course(from.shine, to.shine),
               width_x = course(from.width_x, to.width_x), width_y = course(from.width_y, to.width_y);
  each_eight(span, [&](int k, F x) LANES_BODY {
    const Air air{along(clear, k), along(shine, k), along(width_x, k), along(width_y, k), all(0.0f)};
    return to_screen(ground_light(f, maps, tile, meet(f, ray_at(row, x)).p, air, x, y));
  });
}

LANES void far_span(const FrameData& f, const Maps& maps, const Tile& tile, const Ray& row, const Span& span) {
  const F y = all(static_cast<float>(span.y) + 0.5f);
  each_eight(span, [&](int, F x) LANES_BODY {
    const Ray ray = ray_at(row, x);
    const Meeting at = meet(f, ray);
    const Air air = air_of(f, ray, at);
    return to_screen(with_horizon(f, ground_light(f, maps, tile, at.p, air, x, y), ray, air.far_m)) + dither(x, y);
  });
}

void background(const FrameData& frame, const Maps& all_maps, const Tile& one, const Canvas& out) {
  // copies of its own: a pixel written cannot change them, and what follows from them is computed once
  const FrameData f = frame;
  const Maps maps = all_maps;
  const Tile tile = one;
  constexpr int kSpan = kLanes * kLanes;
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    const Ray row = rays_of_row(f, all(static_cast<float>(y) + 0.5f));
    for (int x = tile.x; x < tile.x + tile.width; x += kSpan) {
      const std::int64_t pixel = y * out.pitch + x;
      const int left = tile.x + tile.width - x;
      const Span span{x, y, left < kSpan ? left : kSpan, out.pixels + 4 * pixel,
                      tile.covered ? tile.covered + std::int64_t{y} * out.width + x : nullptr};
      if (tile.zone == sky)
        sky_span(f, row, span);
      else if (tile.near_ground)
        near_span(f, maps, tile, row, span);
      else
        far_span(f, maps, tile, row, span);
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
