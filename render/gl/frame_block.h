// What every pass of one frame knows: camera, sun, ground, shadow fit, occluders. Computed from the DrawList alone, no GL.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "render/draw_list.h"
#include "render/shade/kernels.h"

namespace render::gl {

/// What hides the sky from the ground, as shade::Occluders has it.
struct OccluderRows {
  static constexpr std::size_t kMostRound = 24, kMostBoxes = 8;
  std::size_t rounds = 0, boxes = 0;
  std::array<float, 12 * kMostRound> round_rows{};
  std::array<float, 12 * kMostBoxes> box_rows{};
  std::array<float, 4 * kMostBoxes> box_half{};
};

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
Rectangle both(const Rectangle&, const Rectangle&);  // what they share
/// Around `count` places x, y, `stride` numbers from one to the next; no more than the picture.
Rectangle around(const float* places, std::size_t count, std::size_t stride, int width, int height);

struct FrameSetup {
  shade::FrameData data{};
  OccluderRows occluders;
  Eigen::Matrix4d world_to_clip;
  Eigen::Matrix4d world_to_shadow_clip;  // -1..1, for drawing the map
  bool casts = false;
  Rectangle objects;  // where things can be seen
  Rectangle shade;    // where their shadow and occlusion on the ground can be seen
  int near_to = 0;    // rows below show near ground alone
  int sky_from = 0;   // rows from here upwards show sky alone
};

/// Whether the background without things is the same picture.
bool same_background(const shade::FrameData&, const shade::FrameData&);

FrameSetup set_up_frame(const DrawList&, const std::vector<CasterBox>&, int width, int height, int shadow_map_size);

}  // namespace render::gl
