// Pieces onto a grid of samples: their vertices projected, their triangles sorted out by depth.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "render/gl/pieces.h"
#include "render/shade/kernels.h"

namespace render::gl {

class Sampler {
 public:
  /// What a picture takes for its own: matrices from the world, the size of the whole in samples.
  struct View {
    Eigen::Matrix4d world_to_clip;
    double width, height;
    float ground = 0;
    bool above_ground = false;  // what has sunk into the ground is hidden by it
  };
  enum class What { names, depth };  // which triangle is seen, or only how near

  /// Forgets what was drawn.
  void clear();
  /// The triangles of `pieces` onto the grid; levels of detail and culling as the pieces have them.
  void draw(const View&, const std::vector<Piece>& pieces, const shade::SampleGrid&);
  /// Into a depth map: the levels within `tolerance` [m], pushed away by their slope and a little more.
  void draw_depth(const View&, const std::vector<Piece>& pieces, double tolerance, const shade::SampleGrid&);

  /// Of the names.
  const std::vector<shade::Triangle>& triangles() const { return triangles_; }
  shade::Projected vertices();

 private:
  void project(const View&, const Piece&, What);
  void draw_run(const View&, const Piece&, const Geometry::Level&, const shade::SampleGrid&, shade::Run);
  std::int32_t add_vertex(const View&, const Eigen::Vector4d& clip, const Eigen::Matrix<double, 7, 1>& rest);

  std::array<std::vector<std::int32_t>, 2> places_;
  std::array<std::vector<float>, 9> numbers_;  // as shade::Projected names them
  std::vector<float> records_;                 // as there
  std::size_t vertex_count_ = 0, first_vertex_ = 0;
  const Geometry* last_geometry_ = nullptr;  // whose vertices are the last that were projected
  Matrix4 last_model_{};
  std::vector<shade::Triangle> triangles_;
  int triangle_count_ = 0;
  std::vector<std::int32_t> to_cut_;
};

}  // namespace render::gl
