// One closed surface over the segments of a person, which bends at the joints.
//
// Built once, in a pose of its own: all segments upright, arms and legs spread so that nothing touches but what hangs together.
// There the surface is the zero of a field: the radial distance to each segment, segments that share a joint blended smoothly with
// a ball at the joint between them. Each vertex then follows the segments it lies near by blended rigid motions (dual quaternions:
// L. Kavan et al., Skinning with Dual Quaternions, 2007), which keep the girth of a bent knee.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "render/stage.h"

namespace render {

/// What build_skin (render/stage.h) makes: closed, counter-clockwise seen from outside.
struct Skin {
  struct Weight {
    int segment = 0;
    float share = 0;  // [-] of a vertex; they sum to 1
  };
  static constexpr std::size_t kWeights = 4;
  std::shared_ptr<const Mesh> mesh;                   // in the pose it was built in
  std::vector<std::array<Weight, kWeights>> weights;  // a vertex
  std::vector<Pose> X_SM;                             // that pose in each segment's frame
};

/// Vertices and normals for segments at X_WS (one a segment). Three floats each, resized as needed.
void bend_skin(const Skin&, std::span<const Pose> X_WS, std::vector<float>& positions, std::vector<float>& normals);

}  // namespace render
