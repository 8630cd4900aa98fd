#include "render/gl/geometry_cache.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "render/surface/orientation.h"
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
    const std::vector<float> normals = has_normals ? mesh->normals : vertex_normals(mesh->positions, mesh->indices);
    set_vertices(*known.geometry, mesh->positions, normals);
    set_levels(*known.geometry, *mesh);
    known.geometry->closed = winding(*mesh);
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
  set_vertices(*known.geometry, item.positions,
               has_normals ? item.normals : vertex_normals(item.positions, item.topology->indices));
  return *known.geometry;
}

}  // namespace render::gl
