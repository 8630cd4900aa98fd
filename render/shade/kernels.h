// A frame, computed on the processor: what is seen, and the light of sky, ground, things. Plain data in, pixels out; what calls it
// (render/gl) keeps the memory. The same source is compiled for every x86-64 processor and for those with AVX2; both give the same
// bytes.
#pragma once

#include <cstdint>

namespace render::shade {

/// What the whole frame shares; names and layout of the numbers as in FrameBlock.
struct FrameData {
  float clip_to_world[16];
  float eye[4], forward[4], sun[4], ground[4], road[4], frame[4];
  float near_0[4], near_x[4], near_y[4], far_0[4], far_x[4], far_y[4];
  float world_to_shadow[16];
  float shadow[4], shadow_size[4], occlusion[4];
};

/// A picture on the ground.
struct Photograph {
  static constexpr int kMostLevels = 16;
  int levels = 0;  // 0: none
  const std::int32_t* texels[kMostLevels] = {};
  int width[kMostLevels] = {}, height[kMostLevels] = {};
  float x = 0, y = 0, cosine = 1, sine = 0;  // [m] its lower left corner, the direction of its lower edge
  float texel = 1;                           // [m] of the finest level
};

/// Pictures that are looked up. Depths have a rim of one texel of depth 1 around them.
struct Maps {
  const std::int32_t* grain;  // 256 x 256, each with its three neighbours to the right and above: a byte each
  const float* depth;
  int depth_size;       // without the rim
  const float* bounds;  // least and largest depth around, two a block
  int bounds_side;
  const float* occlusion;  // rim of one texel of 1
  int occlusion_size;      // without the rim
  float reach;             // [m] radius of the widest penumbra
  int filter;              // 1 plain, 2 soft
  Photograph photograph{};
};

/// Rectangle of one kind of background; numbers as enum Zone and enum Sun. x is a multiple of eight: what changes slowly is
/// computed for every eighth pixel of a row and blended between, the same in whatever tile a pixel lies.
struct Tile {
  int x, y, width, height;
  int zone, sun;
  bool near_ground;
  const std::uint8_t* covered =
      nullptr;  // a byte a pixel of the canvas, lowest row first, and seven more: not 0 where nothing of it will be seen
};

/// RGBA8.
struct Canvas {
  std::uint8_t* pixels;  // of the lowest row
  int width, height;
  std::int64_t pitch;  // [pixels] to the row above; negative where the highest row comes first in memory
};

/// A mesh, one list a number, room for seven more in each.
struct Vertices {
  int count;
  const float *x, *y, *z, *normal_x, *normal_y, *normal_z;
};

/// From a mesh onto a grid of samples.
struct Projection {
  float model_to_clip[16], model_to_world[16];  // by columns
  float half_width, half_height;                // [samples] of the whole picture
  float ground;                                 // [m]
};

/// Vertices as they lie on the grid; room for seven more in each list. Without normals the rest is left out too.
struct Projected {
  std::int32_t *x, *y;   // [1/64 sample]
  float *depth, *per_w;  // 0..1; one over w, nought where the vertex lies before the near plane or far outside
  float *normal_x, *normal_y, *normal_z, *height;  // in the world; [m] above the ground
  float *model_x, *model_y, *model_z;              // as they were
  float* records;  // eight numbers a vertex: x, y [samples], per_w, normal, and two that mean nothing
};

/// Samples x .. x + width, y .. y + height of the picture. Room for seven more behind the last row; beyond `width` no sample is
/// changed.
struct SampleGrid {
  float* depth;         // 0..1, the nearest stays
  std::int32_t* names;  // number of the triangle that is seen; null: depth alone
  std::int64_t pitch;
  int x, y, width, height;
};

/// Triangles of one material on one body.
struct Run {
  const std::uint32_t* indices;
  int triangles;
  std::int32_t first_vertex;  // where in Projected index 0 lies
  int facing;                 // 1: only counter-clockwise ones are seen, -1: only clockwise ones, 0: all
  int closed;                 // which side of a body is outside: 1 counter-clockwise, -1 clockwise, 0 a sheet
  std::int32_t row;           // of the materials
  unsigned kept;              // of two by two samples, bit 2 y + x: those glass does not let through
  bool above_ground;          // what has sunk into the ground is hidden by it
  bool wires;                 // parallels and meridians of an ellipsoid with these
  float axes[3];
  float model_to_world[16];
  float offset_slope, offset;  // of a depth map, as OpenGL's polygon offset
};

/// A triangle that may be seen.
struct Triangle {
  std::int32_t vertices[3];
  std::int32_t row;     // of the materials; from 32768 on: the inside of a body
  std::int32_t facing;  // its mean normal on the octahedron, 16 bits each
  float side;           // -1: the normals are to be turned
};

/// What `raster` adds to.
struct Drawn {
  Triangle* triangles;   // room for all of the run
  int* count;            // also the name of the next
  std::int32_t* to_cut;  // numbers of the run's triangles that reach before the near plane or far outside: not drawn
  int* cut_count;
};

/// What surfaces are seen: one entry a pixel and surface.
struct Surfaces {
  int count;                     // room for seven more in each list
  const float *x, *y;            // pixels
  const float* depth;            // 0..1
  const std::int32_t* triangle;  // one of those that show it
  float *red, *green, *blue;     // out: 0..1 as on the screen
};
struct Scene {
  const float* materials;     // sixteen numbers a row
  const Triangle* triangles;  // room for one more
  Projected vertices;
  float samples;  // a side to a pixel
  bool terrain;   // some may be ground
};

/// Half of a piece of a mark that a tyre left, counter-clockwise on the canvas.
struct MarkTriangle {
  std::int32_t x[3], y[3];       // [1/64 pixel]
  float depth[3], per_w[3];      // 0..1; one over w
  float across[3], darkness[3];  // -1..1 from edge to edge; 0..1
  float place_x[3], place_y[3];  // [m]
};
struct Marks {
  const MarkTriangle* triangles;
  int count;
  int from, to;        // rows
  const float* depth;  // 0..1 of the canvas's pixels, lowest row first, room for seven more; null: nothing hides them
};

struct Occluders {
  int rounds, boxes;
  const float *round_rows, *box_rows, *box_half;
};

struct Kernels {
  void (*background)(const FrameData&, const Maps&, const Tile&, const Canvas&);
  void (*surfaces)(const FrameData&, const Maps&, const Scene&, const Surfaces&);
  void (*project)(const Projection&, const Vertices&, const Projected&);
  void (*raster)(const SampleGrid&, const Projected&, const Run&, const Drawn&);
  void (*marks)(const Maps&, const Marks&, const Canvas&);
  /// A picture, highest row first, in BT.709 limited range: 4:2:0, three planes one after the other;
  /// an odd row or column at the end has no colours of its own.
  void (*i420)(const std::uint8_t* rgba, int width, int height, std::uint8_t* out);
  /// How much of the sky is open at each texel of the occlusion map, into `out` with its rim.
  void (*occlusion)(const FrameData&, const Occluders&, int size, float* out);
};

/// For this processor.
const Kernels& kernels();
/// For every processor.
const Kernels& plain_kernels();

}  // namespace render::shade
