// Triangles on a grid of samples: which of them each sample sees. Corners are snapped to 1/64 of a sample and edges are whole
// numbers, so triangles that share an edge share no sample and leave none out.
//   E(x, y) = A x + B y + C >= 0 on the inside of an edge, (A, B) its normal; samples lie in the middle of their cells.
#pragma once

#include "render/shade/kernels.h"
#include "render/shade/lanes.h"

namespace render::shade {
namespace {

constexpr int kSubBits = 6, kSub = 1 << kSubBits, kHalfSample = kSub / 2;
constexpr float kFarthest = 32000.0f;  // [samples] from the grid's corner: beyond, a triangle is cut

LANES I load_int(const std::int32_t* from) {
  I v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
LANES F load(const float* from) {
  F v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
LANES void store(F v, float* to) {
  __builtin_memcpy(to, &v, sizeof v);
}
LANES void store(I v, std::int32_t* to) {
  __builtin_memcpy(to, &v, sizeof v);
}

void project(const Projection& to, const Vertices& in, const Projected& out) {
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
    const I within = (w > 1e-6f) & (cz >= -w) & (abs(sx) < kFarthest) & (abs(sy) < kFarthest);
    store(to_int(floor(clamp(sx, -kFarthest, kFarthest) * static_cast<float>(kSub) + 0.5f)), out.x + i);
    store(to_int(floor(clamp(sy, -kFarthest, kFarthest) * static_cast<float>(kSub) + 0.5f)), out.y + i);
    store(cz * per_w * 0.5f + 0.5f, out.depth + i);
    store(within ? per_w : all(0.0f), out.per_w + i);
    if (!out.normal_x) continue;
    const float* r = p.model_to_world;
    const F nx = load(in.normal_x + i), ny = load(in.normal_y + i), nz = load(in.normal_z + i);
    store(r[0] * nx + r[4] * ny + r[8] * nz, out.normal_x + i);
    store(r[1] * nx + r[5] * ny + r[9] * nz, out.normal_y + i);
    store(r[2] * nx + r[6] * ny + r[10] * nz, out.normal_z + i);
    store(r[2] * x + r[6] * y + r[10] * z + (r[14] - p.ground), out.height + i);
    store(x, out.model_x + i);
    store(y, out.model_y + i);
    store(z, out.model_z + i);
    F records[kLanes] = {to_float(load_int(out.x + i)) * (1.0f / kSub),
                         to_float(load_int(out.y + i)) * (1.0f / kSub),
                         load(out.per_w + i),
                         load(out.normal_x + i),
                         load(out.normal_y + i),
                         load(out.normal_z + i),
                         all(0.0f),
                         all(0.0f)};
    turn(records);
    for (int k = 0; k < kLanes; ++k) store(records[k], out.records + kLanes * (i + k));
  }
}

struct Edge {
  std::int64_t c = 0;
  std::int32_t a = 0, b = 0;
};

/// Of the line from p to q in 1/64 samples, inside to its left, per sample. A sample on the line belongs to one of its two sides.
LANES Edge edge(std::int32_t px, std::int32_t py, std::int32_t qx, std::int32_t qy) {
  Edge e;
  e.a = py - qy;
  e.b = qx - px;
  const std::int64_t at_0 = std::int64_t{e.a} * (kHalfSample - px) + std::int64_t{e.b} * (kHalfSample - py);
  e.c = (at_0 - (e.a > 0 || (e.a == 0 && e.b > 0) ? 0 : 1)) >> kSubBits;
  return e;
}

/// Its value at the first of eight samples, held back from where 32 bits end: its sign is not touched.
LANES std::int32_t at(const Edge& e, int x, int y) {
  constexpr std::int64_t kEnd = std::int64_t{1} << 30;
  const std::int64_t v = e.c + std::int64_t{e.a} * x + std::int64_t{e.b} * y;
  return static_cast<std::int32_t>(v > kEnd ? kEnd : v < -kEnd ? -kEnd : v);
}

struct Corner {
  std::int32_t x, y;
  float z;
};

/// Depth over the samples: z + per_x x + per_y y. In double precision, for a ground's triangle reaches far beyond the picture.
struct Plane {
  double z, per_x, per_y;
  float least, largest;
};
LANES Plane plane(const Corner& a, const Corner& b, const Corner& c, std::int64_t area) {
  const double x1 = b.x - a.x, y1 = b.y - a.y, x2 = c.x - a.x, y2 = c.y - a.y;
  const double z0 = static_cast<double>(a.z), z1 = static_cast<double>(b.z) - z0, z2 = static_cast<double>(c.z) - z0,
               scale = kSub / static_cast<double>(area);
  Plane p;
  p.per_x = (z1 * y2 - z2 * y1) * scale;
  p.per_y = (z2 * x1 - z1 * x2) * scale;
  p.z = z0 - (p.per_x * (a.x - kHalfSample) + p.per_y * (a.y - kHalfSample)) * (1.0 / kSub);
  const auto smaller = [](float u, float v) { return u < v ? u : v; };
  const auto larger = [](float u, float v) { return u > v ? u : v; };
  p.least = smaller(a.z, smaller(b.z, c.z));
  p.largest = larger(a.z, larger(b.z, c.z));
  return p;
}

LANES double larger_of(double a, double b) {
  a = a < 0 ? -a : a;
  b = b < 0 ? -b : b;
  return a > b ? a : b;
}

/// Parallels and meridians every 20 degrees, about two samples wide.
struct Wires {
  const Run* run;
  const Projected* from;
  std::int32_t v[3];
};

/// Corners' weights at samples x, y (not normalised), from the middle of the first cell.
struct Weights {
  F of[3];
};
LANES Weights weights(const F (&x)[3], const F (&y)[3], const F (&per_w)[3], F at_x, F at_y) {
  Weights out;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    out.of[k] = ((x[j] - x[i]) * (at_y - y[i]) - (y[j] - y[i]) * (at_x - x[i])) * per_w[k];
  }
  return out;
}

LANES I on_wire(const Wires& wires, F x, F y) {
  F px[3], py[3], per_w[3];
  V3 corner[3];
  const Projected& from = *wires.from;
  for (int k = 0; k < 3; ++k) {
    const std::int32_t v = wires.v[k];
    px[k] = all(static_cast<float>(from.x[v] - kHalfSample) * (1.0f / kSub));
    py[k] = all(static_cast<float>(from.y[v] - kHalfSample) * (1.0f / kSub));
    per_w[k] = all(from.per_w[v]);
    const float* axes = wires.run->axes;
    corner[k] = three(from.model_x[v] / axes[0], from.model_y[v] / axes[1], from.model_z[v] / axes[2]);
  }
  const auto direction = [&](F at_x, F at_y) {
    const Weights w = weights(px, py, per_w, at_x, at_y);
    const F per = 1.0f / (w.of[0] + w.of[1] + w.of[2]);
    return normalize((corner[0] * w.of[0] + corner[1] * w.of[1] + corner[2] * w.of[2]) * per);
  };
  const V3 u = direction(x, y), dx = direction(x + 1.0f, y) - u, dy = direction(x, y + 1.0f) - u;
  const F rho2 = max(u.x * u.x + u.y * u.y, 1e-4f), rho = sqrt(rho2);
  const F turn_x = u.x * dx.y - u.y * dx.x, turn_y = u.x * dy.y - u.y * dy.x;
  const F per_longitude = 1.0f / max(sqrt(turn_x * turn_x + turn_y * turn_y), 1e-6f);
  const F per_height = 1.0f / max(sqrt(dx.z * dx.z + dy.z * dy.z), 1e-6f);
  constexpr float kCosines[] = {1, 0.93969262f, 0.76604444f, 0.5f, 0.17364818f};
  constexpr float kSines[] = {0, 0.34202014f, 0.64278761f, 0.86602540f, 0.98480775f};
  F meridian = all(1e9f), parallel = all(1e9f);
  for (int k = 0; k < 9; ++k) {
    const float c = k < 5 ? kCosines[k] : -kCosines[9 - k], s = k < 5 ? kSines[k] : kSines[9 - k];
    meridian = min(meridian, abs(u.y * c - u.x * s));
  }
  for (int k = 0; k < 5; ++k) parallel = min(parallel, abs(abs(u.z) - kSines[k]));
  const F off_meridian = meridian * rho * per_longitude, off_parallel = parallel * per_height;
  return (off_parallel <= 1.1f) | ((off_meridian <= 1.1f) & (rho2 >= 0.01f));
}

/// Samples of one triangle. `kept`: of two by two samples, bit 2 y + x. kSieved: some of them, or wires, are left out.
template <bool kNames, bool kSieved>
LANES void fill(const SampleGrid& grid, const Edge* edges, int edge_count, const Plane& p, int x0, int y0, int x1, int y1,
                std::int32_t name, unsigned kept, const Wires* wires) {
  const I count = {0, 1, 2, 3, 4, 5, 6, 7};
  const F count_f = to_float(count);
  I step[5];
  for (int k = 0; k < edge_count; ++k) step[k] = count * edges[k].a;
  const F per_lane = count_f * static_cast<float>(p.per_x);
  const bool wide = x1 - x0 > 3 * kLanes;
  for (int y = y0; y < y1; ++y) {
    int from = x0, to = x1;
    if (wide)  // where the edges cross this row
      for (int k = 0; k < 3; ++k) {
        const Edge& e = edges[k];
        if (e.a == 0) continue;
        const double crossing = -static_cast<double>(e.c + std::int64_t{e.b} * y) / static_cast<double>(e.a);
        const double held = crossing < -1e6 ? -1e6 : crossing > 1e6 ? 1e6 : crossing;
        const int cell = static_cast<int>(held + 1e6) - 1000000;
        if (e.a > 0 && cell - 1 > from) from = cell - 1;
        if (e.a < 0 && cell + 2 < to) to = cell + 2;
      }
    const std::int64_t row = static_cast<std::int64_t>(y - grid.y) * grid.pitch - grid.x;
    const double z_row = p.z + p.per_y * y;
    for (int x = from; x < to; x += kLanes) {
      I inside = (at(edges[0], x, y) + step[0]) | (at(edges[1], x, y) + step[1]) | (at(edges[2], x, y) + step[2]);
      for (int k = 3; k < edge_count; ++k) inside |= at(edges[k], x, y) + step[k];
      float* const depth = grid.depth + row + x;
      const F z = clamp(static_cast<float>(z_row + p.per_x * x) + per_lane, p.least, p.largest);
      const F before = load(depth);
      I seen = (inside >= 0) & (kNames ? z <= before : z < before);
      if (!any(seen)) continue;
      if constexpr (kNames) {
        if constexpr (kSieved) seen &= ((static_cast<int>(kept >> (2 * (y & 1))) & (1 << ((count + x) & 1))) != 0);
        if constexpr (kSieved)
          if (wires) seen &= on_wire(*wires, count_f + static_cast<float>(x), all(static_cast<float>(y)));
        std::int32_t* const names = grid.names + row + x;
        store(seen ? all(name) : load_int(names), names);
      }
      store(seen ? z : before, depth);
    }
  }
}

/// Octahedral place of a direction, two numbers of 0..65535.
LANES std::int32_t packed(float x, float y, float z) {
  const auto size = [](float v) { return v < 0 ? -v : v; };
  const float sum = size(x) + size(y) + size(z), per = 1.0f / (sum > 1e-20f ? sum : 1e-20f);
  float u = x * per, v = y * per;
  if (z < 0) {
    const float folded_u = (1 - size(v)) * (u < 0 ? -1.0f : 1.0f), folded_v = (1 - size(u)) * (v < 0 ? -1.0f : 1.0f);
    u = folded_u;
    v = folded_v;
  }
  const auto place = [](float w) { return static_cast<std::uint32_t>((0.5f + 0.5f * w) * 65535); };
  return static_cast<std::int32_t>(place(u) | place(v) << 16);
}

/// Which way a triangle's corner normals look: 1 out of its counter-clockwise side.
LANES float outward(const Run& run, const Projected& from, const std::int32_t* v, const float* normal) {
  const auto edge_to = [&](int k, float* d) {
    d[0] = from.model_x[v[k]] - from.model_x[v[0]];
    d[1] = from.model_y[v[k]] - from.model_y[v[0]];
    d[2] = from.model_z[v[k]] - from.model_z[v[0]];
  };
  float a[3], b[3];
  edge_to(1, a);
  edge_to(2, b);
  const float face[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  const float* r = run.model_to_world;
  float dot = 0;
  for (int i = 0; i < 3; ++i) dot += (r[i] * face[0] + r[4 + i] * face[1] + r[8 + i] * face[2]) * normal[i];
  return dot < 0 ? -1.0f : 1.0f;
}

struct Bounds {
  int x0, y0, x1, y1;
};
/// The samples of a window whose middles lie between a triangle's outermost corners.
struct Window {
  int x, y, width, height;
};
LANES Bounds bounds_of(const Corner (&c)[3], const Window& in) {
  const auto least = [](std::int32_t a, std::int32_t b, std::int32_t d) { return a < b ? (a < d ? a : d) : (b < d ? b : d); };
  const auto largest = [](std::int32_t a, std::int32_t b, std::int32_t d) { return a > b ? (a > d ? a : d) : (b > d ? b : d); };
  const auto first = [](std::int32_t low, int end) {
    const int i = (low + kSub - 1 - kHalfSample) >> kSubBits;
    return i > end ? i : end;
  };
  const auto last = [](std::int32_t high, int end) {
    const int i = ((high - kHalfSample) >> kSubBits) + 1;
    return i < end ? i : end;
  };
  return {first(least(c[0].x, c[1].x, c[2].x), in.x), first(least(c[0].y, c[1].y, c[2].y), in.y),
          last(largest(c[0].x, c[1].x, c[2].x), in.x + in.width), last(largest(c[0].y, c[1].y, c[2].y), in.y + in.height)};
}

template <bool kNames>
LANES void draw_run(const SampleGrid& to, const Projected& vertices, const Run& one, const Drawn& out) {
  const SampleGrid grid = to;
  const Projected from = vertices;
  const Run run = one;
  int drawn = *out.count, to_cut = 0;
  for (int t = 0; t < run.triangles; ++t) {
    std::int32_t v[3];
    for (int k = 0; k < 3; ++k) v[k] = run.first_vertex + static_cast<std::int32_t>(run.indices[3 * t + k]);
    Corner c[3] = {{from.x[v[0]], from.y[v[0]], from.depth[v[0]]},
                   {from.x[v[1]], from.y[v[1]], from.depth[v[1]]},
                   {from.x[v[2]], from.y[v[2]], from.depth[v[2]]}};
    if (from.per_w[v[0]] == 0 || from.per_w[v[1]] == 0 || from.per_w[v[2]] == 0) {
      out.to_cut[to_cut++] = t;
      continue;
    }
    const std::int64_t area = std::int64_t{c[1].x - c[0].x} * (c[2].y - c[0].y) - std::int64_t{c[2].x - c[0].x} * (c[1].y - c[0].y);
    if (area == 0 || (area > 0 ? run.facing < 0 : run.facing > 0)) continue;
    const bool front = area > 0;
    if (!front) {  // its edges as of the other side
      const Corner other = c[1];
      c[1] = c[2];
      c[2] = other;
    }
    const int right = grid.x + grid.width;
    const auto [x0, y0, x1, y1] = bounds_of(c, {grid.x, grid.y, grid.width, grid.height});
    if (x0 >= x1 || y0 >= y1) continue;

    Edge edges[5] = {edge(c[0].x, c[0].y, c[1].x, c[1].y), edge(c[1].x, c[1].y, c[2].x, c[2].y),
                     edge(c[2].x, c[2].y, c[0].x, c[0].y), Edge{}, Edge{}};
    int edge_count = 3;
    if (x1 == right) {  // eight at a time would go on beyond
      edges[edge_count].c = right - 1;
      edges[edge_count++].a = -1;
    }
    Plane p = plane(c[0], c[1], c[2], front ? area : -area);
    if constexpr (kNames) {
      float normal[3];
      normal[0] = from.normal_x[v[0]] + from.normal_x[v[1]] + from.normal_x[v[2]];
      normal[1] = from.normal_y[v[0]] + from.normal_y[v[1]] + from.normal_y[v[2]];
      normal[2] = from.normal_z[v[0]] + from.normal_z[v[1]] + from.normal_z[v[2]];
      // whatever the file's winding and normals, the side is lit that is seen
      float side = 1;
      if (run.facing == 0) side = outward(run, from, v, normal) * (front ? 1.0f : -1.0f);
      const bool inside = run.facing == 0 && run.closed * (front ? 1 : -1) < 0;
      if (run.above_ground) {
        const float h[3] = {from.height[v[0]], from.height[v[1]], from.height[v[2]]};
        if (h[0] < 0 && h[1] < 0 && h[2] < 0) continue;
        // height over w is linear over the samples: one more edge
        if (h[0] < 0 || h[1] < 0 || h[2] < 0) {
          Corner g[3];
          for (int k = 0; k < 3; ++k) g[k] = {from.x[v[k]], from.y[v[k]], h[k] * from.per_w[v[k]]};
          const Plane high = plane(g[0], g[1], g[2], area);
          const double steep = larger_of(high.per_x, high.per_y);
          if (steep > 0) {
            const double scale = 1048576 / steep, at_0 = high.z * scale;
            Edge& e = edges[edge_count++];
            e.a = static_cast<std::int32_t>(high.per_x * scale);
            e.b = static_cast<std::int32_t>(high.per_y * scale);
            e.c = static_cast<std::int64_t>(at_0 < -1e15 ? -1e15 : at_0 > 1e15 ? 1e15 : at_0);
          }
        }
      }
      out.triangles[drawn] = {
          {v[0], v[1], v[2]}, run.row + (inside ? 32768 : 0), packed(side * normal[0], side * normal[1], side * normal[2]), side};
      if (run.kept == 15 && !run.wires) {
        fill<true, false>(grid, edges, edge_count, p, x0, y0, x1, y1, drawn, 15, nullptr);
      } else {
        const Wires wires{&run, &from, {v[0], v[1], v[2]}};
        fill<true, true>(grid, edges, edge_count, p, x0, y0, x1, y1, drawn, run.kept, run.wires ? &wires : nullptr);
      }
      ++drawn;
    } else {
      const float more = run.offset_slope * static_cast<float>(larger_of(p.per_x, p.per_y)) + run.offset;
      p.z += static_cast<double>(more);
      p.least += more;
      p.largest += more;
      fill<false, false>(grid, edges, edge_count, p, x0, y0, x1, y1, 0, 15, nullptr);
    }
  }
  *out.count = drawn;
  *out.cut_count = to_cut;
}

void raster(const SampleGrid& grid, const Projected& vertices, const Run& run, const Drawn& out) {
  if (grid.names)
    draw_run<true>(grid, vertices, run, out);
  else
    draw_run<false>(grid, vertices, run, out);
}

}  // namespace
}  // namespace render::shade
