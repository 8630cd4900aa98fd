#include "render/arrange.h"

#include <algorithm>
#include <cassert>
#include <numbers>

#include "render/cameras.h"
#include "render/matrix.h"
#include "render/overlays/overlay.h"
#include "render/sight.h"
#include "render/surface/skin.h"

namespace render {
namespace {

const Camera& camera_named(const Stage& stage, const std::string& name) {
  if (name.empty()) return stage.cameras.front();
  const auto at = std::find_if(stage.cameras.begin(), stage.cameras.end(), [&](const Camera& c) { return c.name == name; });
  assert(at != stage.cameras.end() && "the loader has checked the camera's name");
  return *at;
}

void add_ellipsoid(DrawList& list, const engine::HyperEllipsoid& shape, const Pose& X, const Material& material, bool raster) {
  list.ellipsoids.push_back({shape, to_gl(rigid(X)), material, raster, static_cast<std::uint32_t>(list.ellipsoids.size())});
}

/// Three balls along each segment: where a label would hide a person.
void add_limbs(DrawList& list, const PersonActor& person, const engine::Snapshot& now) {
  for (const PersonActor::Segment& s : person.segments) {
    const Pose& X_WB = now.bodies[static_cast<std::size_t>(s.body)].X_WB;
    Eigen::Index longest = 0;
    const double length = s.shape.semi_axes.maxCoeff(&longest), least = s.shape.semi_axes.minCoeff();
    const double radius = s.shape.semi_axes.sum() - length - least;  // the middle one
    for (const int side : {-1, 0, 1}) {
      const Float3 p = to_float(X_WB * Vec3(side * (length - radius) * Vec3::Unit(longest)));
      list.limbs.push_back({p[0], p[1], p[2], static_cast<float>(radius)});
    }
  }
}

void add_person(DrawList& list, const PersonActor& person, const engine::Snapshot& now) {
  add_limbs(list, person, now);
  if (person.look == PersonLook::skin) {
    list.skins.push_back(bent_skin(person, now));
    return;
  }
  for (const PersonActor::Segment& s : person.segments)
    add_ellipsoid(list, s.shape, now.bodies[static_cast<std::size_t>(s.body)].X_WB, s.material, person.look == PersonLook::raster);
}

Pose place_of(const WheelActor& actor, const engine::WheelRecord& wheel, const engine::Snapshot& now) {
  const engine::Quat body = actor.body < 0 ? engine::Quat::Identity() : now.bodies[static_cast<std::size_t>(actor.body)].X_WB.q;
  return {wheel.hub, body * engine::Quat(Eigen::AngleAxisd(wheel.steer + (actor.left ? 0 : std::numbers::pi), Vec3::UnitZ())) *
                         engine::Quat(Eigen::AngleAxisd(actor.left ? wheel.spin : -wheel.spin, Vec3::UnitY()))};
}

void add_scene(DrawList& list, const Stage& stage, const engine::Snapshot& now) {
  for (const EllipsoidActor& actor : stage.ellipsoids)
    add_ellipsoid(list, actor.shape, now.bodies[static_cast<std::size_t>(actor.body)].X_WB, actor.material, false);
  for (const PersonActor& person : stage.persons) add_person(list, person, now);
  for (const MeshActor& actor : stage.meshes) {
    const Pose X_WB = actor.body < 0 ? Pose{} : now.bodies[static_cast<std::size_t>(actor.body)].X_WB;
    list.meshes.push_back(placed(actor.mesh, X_WB * actor.X_BM, actor.repaint));
  }
  for (const WheelActor& actor : stage.wheels)
    for (const engine::WheelRecord& wheel : now.wheels)
      if (wheel.vehicle == actor.vehicle && wheel.wheel == actor.wheel)
        list.meshes.push_back(placed(actor.mesh, place_of(actor, wheel, now), {}));
  if (stage.road.terrain) list.meshes.push_back(placed(stage.road.terrain, Pose{}, {}));
}

bool wanted(const Overlay& overlay, Layer layer, const Camera& camera) {
  if (camera.kind == CameraKind::eye && overlay.belongs == Belongs::over_scene) return false;
  return layer == Layer::all || (overlay.belongs == Belongs::picture) == (layer == Layer::sheet);
}

}  // namespace

DrawList arrange(const Stage& stage, const engine::Recording& recording, const Moment& moment, double aspect, Layer layer) {
  const Camera& camera = camera_named(stage, moment.camera);
  const engine::Snapshot now = recording.at(moment.time);
  DrawList list;
  list.view = view_of(held_outside(stage, now, camera), recording, moment.time, aspect);
  list.sky = stage.sky;
  list.road = stage.road;
  if (layer != Layer::sheet) add_scene(list, stage, now);
  const Frame frame{stage, recording, now, moment, camera, aspect};
  for (const Overlay* overlay : overlay_table())
    if (wanted(*overlay, layer, camera) && overlay->shown_in(frame)) overlay->add(frame, list);
  return list;
}

MeshItem placed(const std::shared_ptr<const Mesh>& mesh, const Pose& X_WM, const std::vector<Material>& repaint) {
  MeshItem item;
  item.mesh = mesh;
  item.model = to_gl(rigid(X_WM));
  item.materials = mesh->materials;
  for (Material& m : item.materials)
    for (const Material& other : repaint)
      if (other.name == m.name) m = other;
  return item;
}

std::vector<MeshActor> standing(const Stage& stage, int body, const engine::Snapshot& now) {
  std::vector<MeshActor> out;
  for (MeshActor actor : stage.meshes) {
    if (actor.body != body) continue;
    actor.X_BM = now.bodies[static_cast<std::size_t>(body)].X_WB * actor.X_BM;
    actor.body = -1;
    out.push_back(std::move(actor));
  }
  for (const WheelActor& actor : stage.wheels)
    for (const engine::WheelRecord& wheel : now.wheels)
      if (actor.body == body && wheel.vehicle == actor.vehicle && wheel.wheel == actor.wheel)
        out.push_back({"", -1, place_of(actor, wheel, now), actor.mesh, {}});
  return out;
}

SkinItem bent_skin(const PersonActor& person, const engine::Snapshot& now) {
  std::vector<Pose> X_WS;
  for (const PersonActor::Segment& s : person.segments) X_WS.push_back(now.bodies[static_cast<std::size_t>(s.body)].X_WB);
  SkinItem item;
  item.topology = person.skin()->mesh;
  bend_skin(*person.skin(), X_WS, item.positions, item.normals);
  return item;
}

}  // namespace render
