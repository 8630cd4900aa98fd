#include "render/gl/geometry_cache.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "render/surface/simplify.h"
#include "render/surface/tessellate.h"

namespace render::gl {
namespace {

void set_vertices(Geometry& g, const std::vector<float>& positions, const std::vector<float>& normals) {
  const std::size_t count = positions.size() / 3;
  g.count = static_cast<int>(count);
  for (std::vector<float>& list : g.vertices) list.assign(count + 7, 0.0f);
  g.box.setEmpty();
  for (std::size_t v = 0; v < count; ++v) {
    for (std::size_t i = 0; i < 3; ++i) {
      g.vertices[i][v] = positions[3 * v + i];
      g.vertices[3 + i][v] = normals[3 * v + i];
    }
    g.box.extend(Eigen::Vector3f::Map(&positions[3 * v]).cast<double>());
  }
}

/// All levels of the mesh, one behind the other.
void set_levels(Geometry& g, const Mesh& mesh) {
  std::vector<std::uint32_t> indices = mesh.indices;
  std::vector<Geometry::Level> levels{{0, parts_of(mesh)}};
  for (const Mesh::Level& coarse : mesh.levels()) {
    levels.push_back({coarse.tolerance, coarse.parts});
    for (Mesh::Part& run : levels.back().runs) run.first += static_cast<std::uint32_t>(indices.size());
    indices.insert(indices.end(), coarse.indices.begin(), coarse.indices.end());
  }
  g.indices = std::move(indices);
  g.levels = std::move(levels);
}

// area-weighted sums of face normals; the light turns them to the side that is seen
std::vector<float> face_sums(const std::vector<float>& p, const std::vector<std::uint32_t>& indices) {
  std::vector<float> n(p.size(), 0.0f);
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    const std::size_t a = 3 * std::size_t{indices[t]}, b = 3 * std::size_t{indices[t + 1]}, c = 3 * std::size_t{indices[t + 2]};
    const Eigen::Vector3f pa(p[a], p[a + 1], p[a + 2]), pb(p[b], p[b + 1], p[b + 2]), pc(p[c], p[c + 1], p[c + 2]);
    const Eigen::Vector3f area = (pb - pa).cross(pc - pa);
    for (const std::size_t v : {a, b, c})
      for (std::size_t i = 0; i < 3; ++i) n[v + i] += area[static_cast<Eigen::Index>(i)];
  }
  for (std::size_t v = 0; v + 2 < n.size(); v += 3) {
    const float length = std::sqrt(n[v] * n[v] + n[v + 1] * n[v + 1] + n[v + 2] * n[v + 2]);
    if (length > 0)
      for (std::size_t i = 0; i < 3; ++i) n[v + i] /= length;
    else
      n[v + 2] = 1;
  }
  return n;
}

// A body encloses volume; a sheet or a soup of mixed winding encloses little of its box. A tenth lies well between the two: a car
// fills half. Nor is a terrain a body, whatever lies between it and its box: all its triangles face up, those of a body all ways.
int winding(const Mesh& mesh, const Geometry& g) {
  double volume = 0, area = 0;
  Eigen::Vector3d facing = Eigen::Vector3d::Zero();
  const Eigen::Vector3d middle = g.box.center();
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    std::array<Eigen::Vector3d, 3> c;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t v = 3 * std::size_t{mesh.indices[t + k]};
      c[k] = Eigen::Vector3d(mesh.positions[v], mesh.positions[v + 1], mesh.positions[v + 2]) - middle;
    }
    volume += c[0].dot(c[1].cross(c[2])) / 6;
    const Eigen::Vector3d part = (c[1] - c[0]).cross(c[2] - c[0]);
    facing += part;
    area += part.norm();
  }
  if (facing.norm() > 0.2 * area) return 0;
  if (std::abs(volume) <= 0.1 * g.box.volume()) return 0;
  return volume > 0 ? 1 : -1;
}

// Every edge is run along once each way, but for a few borders: what is laid on the body as a sheet, a missing underside.
bool of_one_winding(const Mesh& mesh) {
  constexpr double kBorders = 0.05, kWrong = 0.002;  // of the edges
  const std::vector<std::uint32_t> vertex = welded(mesh);
  std::vector<std::uint64_t> edges, turned;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = vertex[mesh.indices[t + k]], b = vertex[mesh.indices[t + (k + 1) % 3]];
      edges.push_back(a << 32 | b);
      turned.push_back(b << 32 | a);
    }
  std::sort(edges.begin(), edges.end());
  std::sort(turned.begin(), turned.end());
  std::size_t wrong = 0;
  for (std::size_t i = 1; i < edges.size(); ++i) wrong += edges[i] == edges[i - 1] ? 1 : 0;
  std::vector<std::uint64_t> open;
  std::set_difference(edges.begin(), edges.end(), turned.begin(), turned.end(), std::back_inserter(open));
  const double all = static_cast<double>(edges.size());
  return static_cast<double>(open.size()) < kBorders * all && static_cast<double>(wrong) < kWrong * all;
}

}  // namespace

shade::Vertices Geometry::list() const {
  const auto at = [this](std::size_t i) { return vertices[i].data(); };
  return {count, at(0), at(1), at(2), at(3), at(4), at(5)};
}

const Geometry::Level& level_within(const Geometry& g, double tolerance) {
  std::size_t i = 0;
  while (i + 1 < g.levels.size() && g.levels[i + 1].tolerance <= tolerance) ++i;
  return g.levels[i];
}

const Geometry& GeometryCache::ellipsoid(const engine::HyperEllipsoid& e, double tolerance) {
  constexpr std::array<int, 6> kLevels{4, 8, 12, 18, 28, 44};
  std::vector<Level>& levels = ellipsoids_[{e.semi_axes[0], e.semi_axes[1], e.semi_axes[2], e.exponent}];
  for (std::size_t i = 0; i < kLevels.size(); ++i) {
    if (levels.size() <= i) {
      const Tessellation t = tessellate(e, kLevels[i]);
      Level level{kLevels[i], largest_gap(e, t), std::make_unique<Geometry>()};
      set_vertices(*level.geometry, t.positions, t.normals);
      level.geometry->indices = t.indices;
      level.geometry->levels = {{0, {{0, static_cast<std::uint32_t>(t.indices.size()), 0}}}};
      level.geometry->closed = 1;
      level.geometry->shell = true;
      levels.push_back(std::move(level));
    }
    if (levels[i].gap <= tolerance) return *levels[i].geometry;
  }
  return *levels.back().geometry;
}

const Geometry& GeometryCache::mesh(const std::shared_ptr<const Mesh>& mesh) {
  KnownMesh& known = meshes_[mesh.get()];
  if (!known.geometry) {
    known.mesh = mesh;
    known.geometry = std::make_unique<Geometry>();
    const bool has_normals = mesh->normals.size() == mesh->positions.size();
    const std::vector<float> normals = has_normals ? mesh->normals : face_sums(mesh->positions, mesh->indices);
    set_vertices(*known.geometry, mesh->positions, normals);
    set_levels(*known.geometry, *mesh);
    known.geometry->closed = winding(*mesh, *known.geometry);
    known.geometry->shell = known.geometry->closed != 0 && of_one_winding(*mesh);
  }
  return *known.geometry;
}

const Geometry& GeometryCache::skin(const SkinItem& item, std::size_t i) {
  if (skins_.size() <= i) skins_.resize(i + 1);
  KnownMesh& known = skins_[i];
  if (known.mesh != item.topology) {
    known.mesh = item.topology;
    known.geometry = std::make_unique<Geometry>();
    set_levels(*known.geometry, *item.topology);
    // closed and turned outward, as render/surface/skin makes them
    known.geometry->closed = 1;
    known.geometry->shell = true;
    known.geometry->moves = true;
  }
  const bool has_normals = item.normals.size() == item.positions.size();
  set_vertices(*known.geometry, item.positions, has_normals ? item.normals : face_sums(item.positions, item.topology->indices));
  return *known.geometry;
}

}  // namespace render::gl
