// What every pass of one frame knows: camera, sun, ground, shadow fit, occluders. Computed from the DrawList alone, no GL.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/draw_list.h"
#include "render/shade/kernels.h"

namespace render::gl {

constexpr std::size_t kRoundOccluders = 24, kBoxOccluders = 8;

struct FrameBlock {
  // what sky and bare ground depend on: equal bytes mean an equal background
  Matrix4 world_to_clip{}, clip_to_world{};
  Float4 eye{}, forward{}, sun{}, ground{}, road{}, frame{};
  Float4 near_0{}, near_x{}, near_y{}, far_0{}, far_x{}, far_y{};
  // what things add to it
  Matrix4 world_to_shadow{};
  Float4 shadow{}, shadow_size{}, occlusion{0, 0, 1, 1};
  std::array<std::int32_t, 4> counts{};
  std::array<Float4, 3 * kRoundOccluders> round_rows{};
  std::array<Float4, 3 * kBoxOccluders> box_rows{};
  std::array<Float4, kBoxOccluders> box_half{};
};
static_assert(offsetof(FrameBlock, world_to_shadow) == 2 * sizeof(Matrix4) + 12 * sizeof(Float4));

/// As the light wants it.
shade::FrameData frame_data(const FrameBlock&);

/// Whether the background without things is the same picture.
bool same_background(const FrameBlock&, const FrameBlock&);

/// A box in world space: centre and three half edges as columns [m].
struct CasterBox {
  Eigen::Vector3d centre;
  Eigen::Matrix3d half_edges;
  bool round = false;
  bool casts = true;
  bool occludes = true;
};

/// Pixels, lower left origin as GL counts; empty when width or height is 0.
struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

struct FrameSetup {
  FrameBlock block;
  Eigen::Matrix4d world_to_clip;
  Eigen::Matrix4d world_to_shadow_clip;  // -1..1, for drawing the map
  bool casts = false;
  Rectangle objects;  // where things can be seen
  Rectangle shade;    // where their shadow and occlusion on the ground can be seen
  int near_to = 0;    // rows below show near ground alone
  int sky_from = 0;   // rows from here upwards show sky alone
};

FrameSetup set_up_frame(const DrawList&, const std::vector<CasterBox>&, int width, int height, int shadow_map_size);

}  // namespace render::gl
