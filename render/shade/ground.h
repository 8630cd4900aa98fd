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

/// Eight pixels that nothing of the pattern reaches pass it by: the same colours, sooner.
LANES V3 paint_markings(const FrameData& f, const V3& road, F x, F y, float lane, const Footprint& w, const Grain& g) {
  const float half = f.ground[1];
  F paint = bar(abs(y), half - 0.25f, 0.06f, w.y);
  const int lanes = static_cast<int>(f.ground[3]);
  for (int i = 1; i < lanes; ++i) {
    const F line = bar(y, -half + lane * static_cast<float>(i), 0.06f, w.y);
    if (any(line > 0.0f)) paint = max(paint, bars(x, 9, 1.5f, w.x) * line);
  }
  if (f.road[2] > 0.5f) {  // zebra
    const F kept_clear = bar(x, f.road[3], 2.4f, w.x);
    if (any(kept_clear > 0.0f))
      paint =
          max(paint * (1.0f - kept_clear), bar(y, 0, half - 0.45f, w.y) * bar(x, f.road[3], 1.75f, w.x) * bars(y, 1, 0.25f, w.y));
  }
  if (!any(paint > 0.0f)) return road;
  const V3 white = grey(0.62f, 0.62f, 0.60f, 0.93f + 0.55f * g.fine + 0.18f * g.middle);
  return mix(road, white, paint * saturate(1.02f + 0.7f * g.middle));
}

LANES V3 carriageway_colour(const FrameData& f, int zone, F x, F y, const Footprint& w, const Grain& g) {
  const V3 c = grey(0.118f, 0.117f, 0.118f, 1.0f + 0.95f * g.fine + 0.55f * g.middle + 0.40f * g.wide);
  // wheels polish two tracks in each lane
  const float half = f.ground[1], lane = 2 * half / (f.ground[3] > 1 ? f.ground[3] : 1);
  const F track = abs(abs(fract((y + half) * (1 / lane)) - 0.5f) * lane - 0.75f);
  const V3 polished = c * (1.0f + 0.07f * (1.0f - smoothstep(0.1f, 0.5f, track)) - 0.03f);
  return zone == asphalt ? polished : paint_markings(f, polished, x, y, lane, w, g);
}

LANES V3 road_colour(const FrameData& f, int zone, F x, F y, const Footprint& w, const Grain& g) {
  if (zone != everything) return carriageway_colour(f, zone, x, y, w, g);
  // kerb stone, pavement of slabs, grass; each lies over the one before
  const F off = abs(y) - f.ground[1];
  const F kerb = saturate(off * w.y.per + 0.5f), slabs = saturate((off - 0.15f) * w.y.per + 0.5f);
  const F lawn = saturate((off - 2.15f - 0.1f * (g.middle + g.fine)) * min(w.y.per, 50.0f) + 0.5f);
  V3 c = three(0, 0, 0);
  if (any(kerb < 1.0f)) c = carriageway_colour(f, zone, x, y, w, g);
  if (any((kerb > 0.0f) & (slabs < 1.0f))) c = mix(c, grey(0.25f, 0.245f, 0.235f, 1.0f + 0.4f * g.middle + 0.3f * g.fine), kerb);
  if (any((slabs > 0.0f) & (lawn < 1.0f))) c = mix(c, pavement_colour(x, y, w, g), slabs);
  if (any(lawn > 0.0f)) c = mix(c, grass_colour(g), lawn);
  return c;
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

}  // namespace
}  // namespace render::shade
