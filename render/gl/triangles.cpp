#include "render/gl/triangles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "render/matrix.h"

namespace render::gl {
namespace {

constexpr std::size_t kRoom = 7, kRecord = 8, kPlace = 4, kWired = 3;  // [numbers]
constexpr unsigned kAll = 15;
constexpr std::size_t kDrawn = 30'000;  // corners at a time: what is written is read while it is still in the cache

/// Of four samples so many stay as the opacity says, spread evenly.
unsigned kept_samples(const Piece& piece) {
  if (piece.kind != static_cast<int>(MaterialKind::glass)) return kAll;
  unsigned kept = 0;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x)
      if (piece.opacity >= (static_cast<float>((x ^ y) * 2 + y) + 0.5f) / 4) kept |= 1u << (2 * y + x);
  return kept;
}

/// Octahedral place of a direction, 16 bits each.
std::int32_t packed(float x, float y, float z) {
  const float per = 1.0f / std::max(std::abs(x) + std::abs(y) + std::abs(z), 1e-20f);
  float u = x * per, v = y * per;
  if (z < 0) {
    const float folded_u = (1 - std::abs(v)) * (u < 0 ? -1.0f : 1.0f), folded_v = (1 - std::abs(u)) * (v < 0 ? -1.0f : 1.0f);
    u = folded_u;
    v = folded_v;
  }
  const auto place = [](float w) { return static_cast<std::uint32_t>((0.5f + 0.5f * w) * 65535); };
  return static_cast<std::int32_t>(place(u) | place(v) << 16);
}

/// Twice its area on the picture, positive counter-clockwise; corners may lie behind the eye.
double area_of(const float* a, const float* b, const float* c) {
  const auto product = [](const float* p, const float* q) {
    return static_cast<double>(p[0]) * static_cast<double>(q[1]) - static_cast<double>(q[0]) * static_cast<double>(p[1]);
  };
  return product(a, b) * static_cast<double>(c[3]) + product(b, c) * static_cast<double>(a[3]) +
         product(c, a) * static_cast<double>(b[3]);
}

/// Of a corner's place, which is a multiple of 1/64 and within kFarthest of shade/project.h.
int rounded_down(float x) {
  return static_cast<int>(x + 32768) - 32768;
}

/// Whether the middle of a sample of the window can lie in the triangle.
bool may_cover(const float* a, const float* b, const float* c, const Rectangle& window) {
  if (a[3] != 1 || b[3] != 1 || c[3] != 1) return true;  // OpenGL cuts it
  for (int i = 0; i < 2; ++i) {
    const float least = std::min({a[i], b[i], c[i]}), largest = std::max({a[i], b[i], c[i]});
    const float from = static_cast<float>(i == 0 ? window.x : window.y);
    const float size = static_cast<float>(i == 0 ? window.width : window.height);
    if (largest < from || least > from + size) return false;
    if (-rounded_down(0.5f - least) > rounded_down(largest - 0.5f)) return false;
  }
  return true;
}

}  // namespace

/// Triangles of one material on one body.
struct Triangles::Run {
  const std::uint32_t* indices;
  std::size_t count;
  int facing;     // 1: only counter-clockwise ones are seen, -1: only clockwise ones, 0: all
  bool describe;  // for the light
};

Triangles::Triangles() {
  glBindVertexArray(*array_);
  for (GLuint i = 0; i < 4; ++i) glEnableVertexAttribArray(i);
  const auto at = [](std::size_t bytes) { return reinterpret_cast<const void*>(bytes); };
  glBindBuffer(GL_ARRAY_BUFFER, *corner_buffer_);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(Corner), at(offsetof(Corner, x)));
  glVertexAttribPointer(1, 1, GL_FLOAT, GL_FALSE, sizeof(Corner), at(offsetof(Corner, height)));
  glVertexAttribIPointer(2, 1, GL_INT, sizeof(Corner), at(offsetof(Corner, name)));
  glBindBuffer(GL_ARRAY_BUFFER, *wired_buffer_);
  glVertexAttribPointer(3, kWired, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void Triangles::clear() {
  vertex_count_ = first_vertex_ = 0;
  last_geometry_ = nullptr;
  triangles_.assign(1, {});
}

void Triangles::project(const View& view, const Piece& piece, bool describe) {
  const Geometry& g = *piece.geometry;
  if (last_geometry_ == &g && last_model_ == piece.model) return;
  last_geometry_ = &g;
  last_model_ = piece.model;
  first_vertex_ = vertex_count_;
  vertex_count_ += static_cast<std::size_t>(g.count);
  const auto grow = [this](std::vector<float>& list, std::size_t numbers) {
    const std::size_t wanted = numbers * (vertex_count_ + kRoom);
    if (list.size() < wanted) list.resize(std::max(wanted, 3 * list.size() / 2));
  };
  grow(records_, kRecord);
  if (describe) grow(places_, kPlace);
  shade::Projection p{};
  const Matrix4 clip = to_gl(view.world_to_clip * from_gl(piece.model));
  std::copy(clip.begin(), clip.end(), p.model_to_clip);
  std::copy(piece.model.begin(), piece.model.end(), p.model_to_world);
  p.half_width = static_cast<float>(view.width) / 2;
  p.half_height = static_cast<float>(view.height) / 2;
  p.ground = view.ground;
  shade::kernels().project(
      p, g.list(), {records_.data() + kRecord * first_vertex_, describe ? places_.data() + kPlace * first_vertex_ : nullptr});
}

shade::Triangle Triangles::describe(const Piece& piece, const Run& run, const std::uint32_t* v, double area) const {
  std::array<float, 3> normal{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i) normal[i] += records_[kRecord * v[k] + 5 + i];
  float side = 1;
  bool inside = false;
  if (run.facing == 0) {  // whatever the file's winding and normals, the side is lit that is seen
    const auto corner = [&](std::size_t k) { return Eigen::Vector3f::Map(&places_[kPlace * v[k]]); };
    const Eigen::Vector3f face = Eigen::Vector3f(corner(1) - corner(0)).cross(Eigen::Vector3f(corner(2) - corner(0)));
    const float* m = piece.model.data();
    float outward = 0;
    for (std::size_t i = 0; i < 3; ++i) outward += (m[i] * face[0] + m[4 + i] * face[1] + m[8 + i] * face[2]) * normal[i];
    side = (outward < 0) == (area > 0) ? -1.0f : 1.0f;
    inside = piece.geometry->closed * (area > 0 ? 1 : -1) < 0;
  }
  return {{static_cast<std::int32_t>(v[0]), static_cast<std::int32_t>(v[1]), static_cast<std::int32_t>(v[2])},
          piece.row + (inside ? 32768 : 0),
          packed(side * normal[0], side * normal[1], side * normal[2]),
          side};
}

/// The last triangle that was described, or one that need not be.
void Triangles::put(const std::uint32_t* v, bool described, bool wires) {
  for (std::size_t k = 0; k < 3; ++k) {
    const float *record = &records_[kRecord * v[k]], scale = record[4];
    const float* place = described ? &places_[kPlace * v[k]] : nullptr;
    corners_.push_back({record[0], record[1], record[2], record[3], place ? place[3] * scale : 0,
                        static_cast<std::int32_t>(triangles_.size()) - 1});
    for (std::size_t i = 0; wires && i < kWired; ++i) wired_.push_back(place[i] * scale);
  }
}

void Triangles::add(const View& view, const Piece& piece, const Run& run, const Prepare& prepare) {
  const Batch batch{run.describe ? kept_samples(piece) : kAll, run.describe && piece.kind == kWireKind, piece.axes};
  if (batch.kept != batch_.kept || batch.wires || batch_.wires) flush(prepare);
  batch_ = batch;
  for (std::size_t t = 0; t + 2 < run.count; t += 3) {
    std::uint32_t v[3];
    const float* at[3];
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = static_cast<std::uint32_t>(first_vertex_) + run.indices[t + k];
      at[k] = &records_[kRecord * v[k]];
    }
    const double area = area_of(at[0], at[1], at[2]);
    if (area == 0 || run.facing * area < 0 || !may_cover(at[0], at[1], at[2], view.window)) continue;
    if (run.describe) {
      if (view.above_ground && places_[kPlace * v[0] + 3] < 0 && places_[kPlace * v[1] + 3] < 0 && places_[kPlace * v[2] + 3] < 0)
        continue;
      triangles_.push_back(describe(piece, run, v, area));
    }
    put(v, run.describe, batch.wires);
    if (corners_.size() == kDrawn) flush(prepare);
  }
}

void Triangles::draw(const View& view, const std::vector<Piece>& pieces, const Prepare& prepare) {
  clear();
  for (const Piece& piece : pieces) {
    project(view, piece, true);
    const Mesh::Part& part = piece.level->runs[piece.run];
    const int facing = piece.culling == Culling::off ? 0 : piece.geometry->closed > 0 ? 1 : -1;
    add(view, piece, {piece.geometry->indices.data() + part.first, part.count, facing, true}, prepare);
  }
  flush(prepare);
  triangles_.emplace_back();  // the kernel loads eight numbers of the last one's six
}

void Triangles::draw_casters(const View& view, const std::vector<Piece>& pieces, double tolerance) {
  clear();
  const Prepare nothing = [](const Batch&) {};
  for (const Piece& piece : pieces) {
    if (!piece.casts) continue;
    project(view, piece, false);
    const Geometry& g = *piece.geometry;
    const Mesh::Part& part = level_within(g, tolerance).runs[piece.run];
    add(view, piece, {g.indices.data() + part.first, part.count, g.shell ? (g.closed > 0 ? 1 : -1) : 0, false}, nothing);
  }
  flush(nothing);
}

/// OpenGL draws what has come together.
void Triangles::flush(const Prepare& prepare) {
  if (corners_.empty()) return;
  upload(corner_buffer_, corners_);
  if (batch_.wires) upload(wired_buffer_, wired_);
  prepare(batch_);
  glBindVertexArray(*array_);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners_.size()));
  corners_.clear();
  wired_.clear();
}

}  // namespace render::gl
