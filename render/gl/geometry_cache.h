// Triangles as they are drawn: meshes laid out once, ellipsoids once per shape and level of detail, skins every frame.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "render/draw_list.h"
#include "render/shade/kernels.h"

namespace render::gl {

struct Geometry {
  /// Triangles that stay within `tolerance` [m] of the finest, a run of indices a part.
  struct Level {
    double tolerance = 0;
    std::vector<Mesh::Part> runs;
  };
  int count = 0;  // of vertices
  /// Three places and three components of the normal, a list each, with room for seven more.
  std::array<std::vector<float>, 6> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<Level> levels;  // finest first
  Eigen::AlignedBox3d box;    // in its own frame [m]
  int closed = 0;             // 1 counter-clockwise outside, -1 clockwise, 0 a sheet or a soup
  bool shell = false;         // nearly watertight and of one winding: back faces need no drawing
  bool moves = false;         // its vertices are others in the next frame

  shade::Vertices list() const;
};

/// The coarsest level within `tolerance` [m].
const Geometry::Level& level_within(const Geometry&, double tolerance);

class GeometryCache {
 public:
  /// Level of detail whose triangles stay within `tolerance` [m]; the choice depends on shape and tolerance alone.
  const Geometry& ellipsoid(const engine::HyperEllipsoid&, double tolerance);
  /// Laid out at first sight and kept while the mesh lives.
  const Geometry& mesh(const std::shared_ptr<const Mesh>&);
  /// Vertices are laid out anew at each call; the i-th skin of the frame reuses the i-th place.
  const Geometry& skin(const SkinItem&, std::size_t i);

 private:
  using Shape = std::array<double, 4>;
  struct Level {
    int cells = 0;
    double gap = 0;
    std::unique_ptr<Geometry> geometry;
  };
  struct KnownMesh {
    std::shared_ptr<const Mesh> mesh;  // held, so that its address is never another mesh's
    std::unique_ptr<Geometry> geometry;
  };
  std::map<Shape, std::vector<Level>> ellipsoids_;
  std::map<const Mesh*, KnownMesh> meshes_;
  std::vector<KnownMesh> skins_;
};

}  // namespace render::gl
