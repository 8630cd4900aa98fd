// Marks of tyres: rubber over the ground, or over what stands on it where its depth lets them be seen.
#pragma once

#include "render/shade/ground.h"
#include "render/shade/raster.h"

namespace render::shade {
namespace {

constexpr float kRubber = 0.0402f;           // 0.012 on the tone curve
constexpr double kLifted = 2.0 / (1 << 24);  // [-] of the depth, before what a triangle's slope adds to it

/// Part of the ground a mark hides, at pixels x, y.
LANES F mark_cover(const Maps& maps, const MarkTriangle& t, F x, F y) {
  F px[3], py[3], per_w[3];
  for (int k = 0; k < 3; ++k) {
    px[k] = all(static_cast<float>(t.x[k]) * (1.0f / kSub));
    py[k] = all(static_cast<float>(t.y[k]) * (1.0f / kSub));
    per_w[k] = all(t.per_w[k]);
  }
  const auto normalised = [&](F at_x, F at_y) {
    Weights w = weights(px, py, per_w, at_x, at_y);
    const F sum = w.of[0] + w.of[1] + w.of[2], per = 1.0f / (abs(sum) > 1e-30f ? sum : all(1e-30f));
    for (F& each : w.of) each = each * per;
    return w;
  };
  const auto blend = [](const float* values, const Weights& w) {
    return values[0] * w.of[0] + values[1] * w.of[1] + values[2] * w.of[2];
  };
  const Weights here = normalised(x, y), right = normalised(x + 1.0f, y), up = normalised(x, y + 1.0f);
  const auto change = [&](const float* values, F at_here) {
    return abs(blend(values, right) - at_here) + abs(blend(values, up) - at_here);
  };
  const F across = blend(t.across, here), place_x = blend(t.place_x, here), place_y = blend(t.place_y, here);
  const F width = max(change(t.across, across), 1e-4f);
  const F edge = saturate((1.0f - abs(across)) / max(width, 0.22f));
  const F size = 0.7f * max(change(t.place_x, place_x), change(t.place_y, place_y));
  const F rough = 0.75f + 0.9f * grain(maps, place_x, place_y, 1.07f, size);
  // ribs of the tread run along the mark
  constexpr float kRibs = 12 / 6.2831853f;
  const F ribs = mix(0.8f + 0.2f * sine_of_turn(across * kRibs + 0.25f), all(0.8f), smoothstep(0.15f, 0.5f, width));
  return saturate(blend(t.darkness, here) * edge * rough * ribs) * 0.8f;
}

/// Laid over eight pixels, of which the first `count` are the canvas's.
LANES void lay_rubber(F cover, int count, std::uint8_t* at) {
  I pixels = all(0);
  const unsigned bytes = sizeof(std::int32_t) * static_cast<unsigned>(count);
  __builtin_memcpy(&pixels, at, count == kLanes ? sizeof pixels : bytes);
  const auto channel = [&](int shift) {
    const F old = to_float((pixels >> shift) & 255);
    return to_int(old + (255 * kRubber - old) * cover + 0.5f) << shift;
  };
  const I laid = channel(0) | channel(8) | channel(16) | static_cast<std::int32_t>(0xff000000u);
  __builtin_memcpy(at, &laid, count == kLanes ? sizeof laid : bytes);
}

LANES void lay_mark(const Maps& maps, const MarkTriangle& t, const Marks& marks, const Canvas& canvas) {
  const Corner c[3] = {{t.x[0], t.y[0], t.depth[0]}, {t.x[1], t.y[1], t.depth[1]}, {t.x[2], t.y[2], t.depth[2]}};
  const std::int64_t area = std::int64_t{c[1].x - c[0].x} * (c[2].y - c[0].y) - std::int64_t{c[2].x - c[0].x} * (c[1].y - c[0].y);
  if (area <= 0) return;
  const Bounds b = bounds_of(c, {0, marks.from, canvas.width, marks.to - marks.from});
  const Edge edges[3] = {edge(c[0].x, c[0].y, c[1].x, c[1].y), edge(c[1].x, c[1].y, c[2].x, c[2].y),
                         edge(c[2].x, c[2].y, c[0].x, c[0].y)};
  const Plane p = plane(c[0], c[1], c[2], area);
  const double lifted = kLifted + larger_of(p.per_x, p.per_y);
  const I lane = {0, 1, 2, 3, 4, 5, 6, 7};
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; x += kLanes) {
      I seen = lane < b.x1 - x;
      for (const Edge& e : edges) seen &= at(e, x, y) + lane * e.a >= 0;
      if (!any(seen)) continue;
      if (marks.depth) {
        const F z = static_cast<float>(p.z + p.per_x * x + p.per_y * y - lifted) + to_float(lane) * static_cast<float>(p.per_x);
        seen &= z <= load(marks.depth + std::int64_t{y} * canvas.width + x);
      }
      const F cover = mark_cover(maps, t, count_up(static_cast<float>(x) + 0.5f), all(static_cast<float>(y) + 0.5f));
      const int left = canvas.width - x;
      lay_rubber(seen ? cover : all(0.0f), left < kLanes ? left : kLanes, canvas.pixels + 4 * (y * canvas.pitch + x));
    }
}

void marks(const Maps& all_maps, const Marks& all_marks, const Canvas& canvas) {
  const Maps maps = all_maps;
  const Marks list = all_marks;
  for (int i = 0; i < list.count; ++i) lay_mark(maps, list.triangles[i], list, canvas);
}

}  // namespace
}  // namespace render::shade
