// The light of a frame, computed on the processor: sky, ground, things. Plain data in, pixels out; what calls it (render/gl) keeps
// the memory. The same source is compiled for every x86-64 processor and for those with AVX2; both give the same bytes.
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

/// Rectangle of one kind of background; numbers as enum Zone and enum Sun.
struct Tile {
  int x, y, width, height;
  int zone, sun;
  bool near_ground;
};

/// RGBA8, lowest row first.
struct Canvas {
  std::uint8_t* pixels;
  int width;  // of a row
};

/// What surfaces are seen, in pieces: one piece a pixel and surface.
struct Pieces {
  int count;           // room for seven more in each list
  const float *x, *y;  // pixels
  const float* depth;  // 0..1
  const float *u, *v;  // normal on the octahedron, 0..1
  const float* grain;
  const std::int32_t* row;    // of the materials; from 32768 on: the inside of a body
  float *red, *green, *blue;  // out: 0..1 as on the screen
};

struct Occluders {
  int rounds, boxes;
  const float *round_rows, *box_rows, *box_half;
};

struct Kernels {
  void (*background)(const FrameData&, const Maps&, const Tile&, const Canvas&);
  /// `materials`: sixteen numbers a row. `terrain`: some may be ground.
  void (*surfaces)(const FrameData&, const Maps&, const float* materials, bool terrain, const Pieces&);
  /// How much of the sky is open at each texel of the occlusion map, into `out` with its rim.
  void (*occlusion)(const FrameData&, const Occluders&, int size, float* out);
};

/// For this processor.
const Kernels& kernels();
/// For every processor.
const Kernels& plain_kernels();

}  // namespace render::shade
