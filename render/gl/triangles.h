// A view's triangles on their way to OpenGL. Their corners are brought to the view here, in a given order of operations and onto
// 1/64 of a sample, so that which samples they cover does not depend on the processor; what OpenGL still multiplies them by are
// powers of two. What cannot be seen (back faces, triangles between samples) is left out. Each triangle has corners of its own,
// which carry its number: llvmpipe takes a fifth less time for them than for shared corners and gl_PrimitiveID.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "render/gl/names.h"
#include "render/gl/pieces.h"
#include "render/shade/kernels.h"

namespace render::gl {

class Triangles {
 public:
  struct View {
    Eigen::Matrix4d world_to_clip;
    int width, height;  // [samples] of the whole picture
    Rectangle window;   // [samples] of it that is drawn
    float ground = 0;
    bool above_ground = false;  // what has sunk into the ground is hidden by it
  };
  /// One draw call.
  struct Batch {
    unsigned kept;  // of two by two samples, bit 2 y + x: those glass does not let through
    bool wires;     // parallels and meridians of an ellipsoid with these
    Float3 axes;
  };

  Triangles();
  using Prepare = std::function<void(const Batch&)>;
  /// Levels of detail and culling as the pieces have them. `prepare` readies program and state for each call.
  void draw(const View&, const std::vector<Piece>&, const Prepare& prepare);
  /// What throws shadows, at the levels within `tolerance` [m]; not described.
  void draw_casters(const View&, const std::vector<Piece>&, double tolerance);

  /// By number; 0 is nothing, and the last is room.
  const std::vector<shade::Triangle>& described() const { return triangles_; }
  shade::Corners corners() { return {records_.data(), places_.data()}; }

 private:
  struct Run;
  void clear();
  void project(const View&, const Piece&, bool describe);
  void add(const View&, const Piece&, const Run&, const Prepare&);
  void flush(const Prepare&);
  void put(const std::uint32_t* v, bool described, bool wires);
  shade::Triangle describe(const Piece&, const Run&, const std::uint32_t* v, double area) const;

  /// As object.vert.glsl has it.
  struct Corner {
    float x, y, depth, w;
    float height;       // [m] above the ground, scaled as the corner is
    std::int32_t name;  // of the triangle
  };

  std::vector<float> records_, places_;  // as shade::Corners names them
  std::vector<Corner> corners_;          // of the next call
  std::vector<float> wired_;             // where there are wires: places of corners in their mesh, scaled as they are
  Batch batch_{};
  std::vector<shade::Triangle> triangles_;
  std::size_t vertex_count_ = 0, first_vertex_ = 0;
  const Geometry* last_geometry_ = nullptr;  // whose vertices are the last that were projected
  Matrix4 last_model_{};
  VertexArray array_;
  Buffer corner_buffer_, wired_buffer_;
};

}  // namespace render::gl
