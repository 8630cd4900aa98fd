#include "render/gl/pieces.h"

#include <algorithm>
#include <cmath>

#include "render/matrix.h"

namespace render::gl {
namespace {

using Eigen::Vector3d;

// [pixels] that a coarser level may be off. What is laid on a body, a seam or a lamp, lies a millimetre or two before it and must
// not sink in; a skin is one surface
constexpr double kMeshShare = 0.15, kSkinShare = 0.6;
constexpr double kSmallMesh = 1.5;  // [m] across: a wheel, a crate; occludes as something round
constexpr Matrix4 kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

CasterBox box_of(const Geometry& g, const Matrix4& model) {
  const Eigen::Matrix4d X = from_gl(model);
  CasterBox b;
  b.centre = (X * g.box.center().homogeneous()).head<3>();
  const Vector3d half = (g.box.sizes() / 2).cwiseMax(1e-3);
  b.half_edges = X.topLeftCorner<3, 3>() * half.asDiagonal();
  b.round = 2 * half.norm() < kSmallMesh;
  return b;
}

// whether the point lies in the mesh's box
bool holds(const Geometry& g, const Matrix4& model, const Vector3d& point) {
  return g.box.contains((from_gl(model).inverse() * point.homogeneous()).head<3>());
}

// what stands on the ground of a moving surface: its lowest part, in two halves (two feet)
void add_feet(const SkinItem& skin, double ground, std::vector<CasterBox>& boxes) {
  constexpr double kFoot = 0.25;  // [m]
  std::vector<Vector3d> low;
  Eigen::AlignedBox3d whole;
  for (std::size_t v = 0; v + 2 < skin.positions.size(); v += 3) {
    const Vector3d p(skin.positions[v], skin.positions[v + 1], skin.positions[v + 2]);
    if (p.z() > ground + kFoot) continue;
    low.push_back(p);
    whole.extend(p);
  }
  if (low.empty()) return;
  const int axis = whole.sizes().x() > whole.sizes().y() ? 0 : 1;
  for (const int side : {-1, 1}) {
    Eigen::AlignedBox3d foot;
    for (const Vector3d& p : low)
      if (side * (p[axis] - whole.center()[axis]) >= 0) foot.extend(p);
    if (foot.isEmpty()) continue;
    CasterBox box;
    box.centre = foot.center();
    box.half_edges = (foot.sizes() / 2).cwiseMax(0.02).asDiagonal();
    box.round = true;
    boxes.push_back(box);
  }
}

}  // namespace

std::vector<Piece> collect(const DrawList& list, GeometryCache& geometry, MaterialTable& table, double pixel_share, int height,
                           std::vector<CasterBox>& boxes) {
  std::vector<Piece> out;
  table.clear();
  const Vector3d eye(list.view.eye[0], list.view.eye[1], list.view.eye[2]);
  const double focal = std::abs(static_cast<double>(list.view.eye_to_clip[5]));
  for (const EllipsoidItem& e : list.ellipsoids) {
    const Vector3d centre(e.model[12], e.model[13], e.model[14]);
    const double away = std::max((centre - eye).norm() - e.shape.semi_axes.maxCoeff(), 0.1);
    const double pixel = 2 / (focal * height) * (list.view.orthographic ? 1.0 : away);
    const Geometry& g = geometry.ellipsoid(e.shape, pixel_share * pixel);
    const int kind = e.raster ? kWireKind : static_cast<int>(e.material.kind);
    out.push_back({&g, &g.levels[0], 0, table.add(e.material, false), e.material.opacity, kind, e.model,
                   to_float(e.shape.semi_axes), !e.raster, e.raster ? Culling::off : Culling::on});
    boxes.push_back(box_of(g, e.model));
    boxes.back().round = true;
    boxes.back().casts = !e.raster;
  }
  const auto pixel_at = [&](const CasterBox& box) {  // [m] at its nearest
    const double away = std::max((box.centre - eye).norm() - box.half_edges.norm(), 0.3);
    return 2 / (focal * height) * (list.view.orthographic ? 1.0 : away);
  };
  const auto add_parts = [&](const Mesh& mesh, const Geometry& g, const Geometry::Level& level, const Matrix4& model,
                             const std::vector<Material>& paint, bool terrain) {
    const bool within = !list.view.orthographic && holds(g, model, eye);
    for (std::size_t run = 0; run < level.runs.size(); ++run) {
      if (level.runs[run].count == 0) continue;
      const std::size_t m = static_cast<std::size_t>(std::max(level.runs[run].material, 0));
      const Material material = m < paint.size() ? paint[m] : m < mesh.materials.size() ? mesh.materials[m] : Material{};
      const int kind = terrain ? kTerrainKind : static_cast<int>(material.kind);
      if (within && material.kind == MaterialKind::glass) continue;  // from within, panes are clear
      const Culling culling = g.shell && !within ? Culling::on : Culling::off;
      out.push_back({&g, &level, run, table.add(material, terrain), material.opacity, kind, model, {}, !terrain, culling});
    }
  };
  for (const MeshItem& item : list.meshes) {
    const Geometry& g = geometry.mesh(item.mesh);
    if (item.mesh->indices.empty()) continue;
    const bool terrain = item.mesh == list.road.terrain;
    const CasterBox box = box_of(g, item.model);
    add_parts(*item.mesh, g, level_within(g, terrain ? 0 : kMeshShare * pixel_at(box)), item.model, item.materials,
              terrain && list.road.road);
    if (!terrain) boxes.push_back(box);
  }
  for (std::size_t i = 0; i < list.skins.size(); ++i) {
    const Geometry& g = geometry.skin(list.skins[i], i);
    if (list.skins[i].topology->indices.empty()) continue;
    CasterBox box = box_of(g, kIdentity);
    add_parts(*list.skins[i].topology, g, level_within(g, kSkinShare * pixel_at(box)), kIdentity, list.skins[i].materials, false);
    box.round = true;
    box.occludes = false;  // its feet do
    boxes.push_back(box);
    add_feet(list.skins[i], list.road.height, boxes);
  }
  return out;
}

}  // namespace render::gl
