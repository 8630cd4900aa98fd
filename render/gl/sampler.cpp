#include "render/gl/sampler.h"

#include <algorithm>
#include <cmath>

#include "render/gl/cut.h"
#include "render/matrix.h"

namespace render::gl {
namespace {

using Eigen::Vector4d;
using Rest = Eigen::Matrix<double, 7, 1>;  // normal, height, place in the mesh

constexpr std::size_t kRoom = 7, kRecord = 8;  // [numbers]

/// Of four samples so many stay as the opacity says, spread evenly.
unsigned kept_samples(const Piece& piece) {
  if (piece.kind != static_cast<int>(MaterialKind::glass)) return 15;
  unsigned kept = 0;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x)
      if (piece.opacity >= (static_cast<float>((x ^ y) * 2 + y) + 0.5f) / 4) kept |= 1u << (2 * y + x);
  return kept;
}

}  // namespace

void Sampler::clear() {
  vertex_count_ = first_vertex_ = 0;
  last_geometry_ = nullptr;
  triangle_count_ = 0;
}

shade::Projected Sampler::vertices() {
  const auto at = [this](std::size_t i) { return numbers_[i].data(); };
  return {places_[0].data(), places_[1].data(), at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8), records_.data()};
}

void Sampler::project(const View& view, const Piece& piece, What what) {
  const Geometry& g = *piece.geometry;
  if (last_geometry_ == &g && last_model_ == piece.model) return;
  last_geometry_ = &g;
  last_model_ = piece.model;
  first_vertex_ = what == What::depth ? 0 : vertex_count_;
  vertex_count_ = first_vertex_ + static_cast<std::size_t>(g.count);
  const std::size_t room = vertex_count_ + kRoom;
  const auto grow = [room](auto& list) {
    if (list.size() < room) list.resize(std::max(room, 2 * list.size()));
  };
  for (auto& list : places_) grow(list);
  for (auto& list : numbers_) grow(list);
  if (records_.size() < kRecord * room) records_.resize(std::max(kRecord * room, 2 * records_.size()));
  shade::Projection p{};
  const Matrix4 clip = to_gl(view.world_to_clip * from_gl(piece.model));
  std::copy(clip.begin(), clip.end(), p.model_to_clip);
  std::copy(piece.model.begin(), piece.model.end(), p.model_to_world);
  p.half_width = static_cast<float>(view.width / 2);
  p.half_height = static_cast<float>(view.height / 2);
  p.ground = view.ground;
  shade::Projected out = vertices();
  out.x += first_vertex_;
  out.y += first_vertex_;
  for (float** list :
       {&out.depth, &out.per_w, &out.normal_x, &out.normal_y, &out.normal_z, &out.height, &out.model_x, &out.model_y, &out.model_z})
    *list += first_vertex_;
  out.records += kRecord * first_vertex_;
  if (what == What::depth) out.normal_x = nullptr;
  shade::kernels().project(p, g.list(), out);
}

void Sampler::draw_run(const View& view, const Piece& piece, const Geometry::Level& level, const shade::SampleGrid& grid,
                       shade::Run run) {
  const Mesh::Part& part = level.runs[piece.run];
  run.indices = piece.geometry->indices.data() + part.first;
  run.triangles = static_cast<int>(part.count / 3);
  run.first_vertex = static_cast<std::int32_t>(first_vertex_);
  run.closed = piece.geometry->closed;
  std::copy(piece.model.begin(), piece.model.end(), run.model_to_world);
  const std::size_t most = static_cast<std::size_t>(run.triangles);
  if (to_cut_.size() < most) to_cut_.resize(most);
  const std::size_t room = static_cast<std::size_t>(triangle_count_) + most + 1;
  if (grid.names && triangles_.size() < room) triangles_.resize(std::max(room, 2 * triangles_.size()));
  int cut_count = 0;
  shade::kernels().raster(grid, vertices(), run, {triangles_.data(), &triangle_count_, to_cut_.data(), &cut_count});
  if (cut_count > 0) {
    const Geometry& g = *piece.geometry;
    const Eigen::Matrix4d world = from_gl(piece.model), clip = view.world_to_clip * world;
    std::vector<std::int32_t> numbers(to_cut_.begin(), to_cut_.begin() + cut_count);
    std::vector<std::uint32_t> corners;
    for (const std::int32_t t : numbers) {
      CutPolygon<7> polygon;
      for (int k = 0; k < 3; ++k) {
        const std::size_t v = run.indices[3 * t + k];
        const Eigen::Vector3d p(g.vertices[0][v], g.vertices[1][v], g.vertices[2][v]),
            n(g.vertices[3][v], g.vertices[4][v], g.vertices[5][v]);
        Rest rest;
        rest << world.topLeftCorner<3, 3>() * n, (world * p.homogeneous()).z() - static_cast<double>(view.ground), p;
        polygon.push_back({clip * p.homogeneous(), rest});
      }
      polygon = cut_to_grid(polygon, view.width, view.height);
      std::vector<std::uint32_t> names;
      for (const CutPoint<7>& p : polygon) names.push_back(static_cast<std::uint32_t>(add_vertex(view, p.clip, p.rest)));
      for (std::size_t i = 2; i < names.size(); ++i) corners.insert(corners.end(), {names[0], names[i - 1], names[i]});
    }
    run.indices = corners.data();
    run.triangles = static_cast<int>(corners.size() / 3);
    run.first_vertex = 0;
    const std::size_t more = static_cast<std::size_t>(triangle_count_ + run.triangles) + 1;
    if (grid.names && triangles_.size() < more) triangles_.resize(std::max(more, 2 * triangles_.size()));
    if (to_cut_.size() < corners.size()) to_cut_.resize(corners.size());
    shade::kernels().raster(grid, vertices(), run, {triangles_.data(), &triangle_count_, to_cut_.data(), &cut_count});
  }
}

std::int32_t Sampler::add_vertex(const View& view, const Vector4d& clip, const Rest& rest) {
  const std::size_t v = vertex_count_++, room = v + 1 + kRoom;
  const auto grow = [room](auto& list) {
    if (list.size() < room) list.resize(std::max(room, 2 * list.size()));
  };
  for (auto& list : places_) grow(list);
  for (auto& list : numbers_) grow(list);
  places_[0][v] = sub_sample(clip[0] / clip[3], view.width);
  places_[1][v] = sub_sample(clip[1] / clip[3], view.height);
  numbers_[0][v] = static_cast<float>(clip[2] / clip[3] * 0.5 + 0.5);
  numbers_[1][v] = static_cast<float>(1 / clip[3]);
  for (std::size_t i = 0; i < 7; ++i) numbers_[2 + i][v] = static_cast<float>(rest[static_cast<Eigen::Index>(i)]);
  if (records_.size() < kRecord * room) records_.resize(std::max(kRecord * room, 2 * records_.size()));
  float* const record = records_.data() + kRecord * v;
  for (std::size_t i = 0; i < 2; ++i) record[i] = static_cast<float>(places_[i][v] / kSub);
  for (std::size_t i = 0; i < 4; ++i) record[2 + i] = numbers_[1 + i][v];
  return static_cast<std::int32_t>(v);
}

void Sampler::draw(const View& view, const std::vector<Piece>& pieces, const shade::SampleGrid& grid) {
  for (const Piece& piece : pieces) {
    project(view, piece, What::names);
    shade::Run run{};
    run.facing = piece.culling == Culling::off ? 0 : piece.geometry->closed > 0 ? 1 : -1;
    run.row = piece.row;
    run.kept = kept_samples(piece);
    run.above_ground = view.above_ground;
    run.wires = piece.kind == kWireKind;
    std::copy(piece.axes.begin(), piece.axes.end(), run.axes);
    draw_run(view, piece, *piece.level, grid, run);
  }
}

void Sampler::draw_depth(const View& view, const std::vector<Piece>& pieces, double tolerance, const shade::SampleGrid& grid) {
  for (const Piece& piece : pieces) {
    if (!piece.casts) continue;
    project(view, piece, What::depth);
    shade::Run run{};
    run.facing = piece.geometry->shell ? (piece.geometry->closed > 0 ? 1 : -1) : 0;
    run.offset_slope = 1.5f;
    run.offset = 2.5e-7f;
    draw_run(view, piece, level_within(*piece.geometry, tolerance), grid, run);
  }
  last_geometry_ = nullptr;
}

}  // namespace render::gl
