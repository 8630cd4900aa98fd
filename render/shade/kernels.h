// A frame, computed on the processor: what is seen, and the light of sky, ground, things. Plain data in, pixels out; what calls it
// (render/gl) keeps the memory. The same source is compiled for every x86-64 processor and for those with AVX2; both give the same
// bytes.
#pragma once

#include <cstdint>

namespace render::shade {

/// What the whole frame shares: camera, sun, ground, where the shadow map lies. What sky and bare ground depend on stands first:
/// equal bytes up to `world_to_shadow` mean an equal background.
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

/// From a mesh onto the samples of a picture.
struct Projection {
  float model_to_clip[16], model_to_world[16];  // by columns
  float half_width, half_height;                // [samples] of the whole picture
  float ground;                                 // [m]
};

/// Vertices on the samples; room for seven more. A vertex that lies before the eye and not too far aside is scaled to w = 1 and
/// snapped to 1/64 of a sample; others stay as they are in clip space, for OpenGL to cut.
struct Corners {
  float* records;  // eight numbers a vertex: x, y [samples], depth 0..1, w, what it was scaled by, normal in the world
  float* places;   // four: place in the mesh, height above the ground [m]; null: not wanted, nor is the normal
};

/// A triangle that may be seen.
struct Triangle {
  std::int32_t vertices[3];
  std::int32_t row;     // of the materials; from 32768 on: the inside of a body
  std::int32_t facing;  // its mean normal on the octahedron, 16 bits each
  float side;           // -1: the normals are to be turned
};

/// What surfaces are seen: one entry a pixel and surface.
struct Surfaces {
  int count;                     // room for seven more in each list
  const float *x, *y;            // pixels
  const std::int32_t* triangle;  // one of those that show it
  float *red, *green, *blue;     // out: 0..1 as on the screen
};
struct Scene {
  const float* materials;     // sixteen numbers a row
  const Triangle* triangles;  // room for one more
  Corners corners;
  float samples;  // a side to a pixel
  bool terrain;   // some may be ground
};

struct Occluders {
  int rounds, boxes;
  const float *round_rows, *box_rows, *box_half;
};

struct Kernels {
  void (*background)(const FrameData&, const Maps&, const Tile&, const Canvas&);
  void (*surfaces)(const FrameData&, const Maps&, const Scene&, const Surfaces&);
  void (*project)(const Projection&, const Vertices&, const Corners&);
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
