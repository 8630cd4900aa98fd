#include "render/sight.h"

#include <algorithm>

namespace render {

double free_share(const Stage& stage, const engine::Snapshot& now, const Vec3& from, const Vec3& way) {
  double share = 1;
  const auto meet = [&](const engine::TriangleMesh& solid, const Pose& X_WM) {
    const Pose X_MW = X_WM.inverse();
    double s = 0;
    int triangle = -1;
    if (solid.raycast(X_MW * from, X_MW.q * way, share, s, triangle)) share = s;
  };
  for (const MeshActor& actor : stage.meshes) {
    if (!actor.solid) continue;
    meet(*actor.solid, actor.body < 0 ? actor.X_BM : now.bodies[static_cast<std::size_t>(actor.body)].X_WB * actor.X_BM);
  }
  if (stage.road.terrain_surface)
    meet(*stage.road.terrain_surface, Pose{});
  else if (way.z() < 0)
    share = std::clamp((stage.road.height - from.z()) / way.z(), 0.0, share);
  return share;
}

Camera held_outside(const Stage& stage, const engine::Snapshot& now, const Camera& camera) {
  constexpr double kClear = 0.5;  // [m] at least before the eye
  Camera out = camera;
  if (camera.kind != CameraKind::eye) return out;
  for (const PersonActor& person : stage.persons)
    for (const PersonActor::Segment& segment : person.segments) {
      if (person.name != camera.follow || segment.name != "head") continue;
      const Pose& X_WB = now.bodies[static_cast<std::size_t>(segment.body)].X_WB;
      const Vec3 ahead = (camera.target - camera.position).normalized();
      const double reach = camera.position.dot(ahead) + kClear;  // from the middle of the head
      const double missing = reach * (1 - free_share(stage, now, X_WB.p, X_WB.q * (reach * ahead)));
      if (missing == 0) continue;
      // as far aside as back, past the head: over the crown unless something is there too
      for (const Vec3& aside : {Vec3(Vec3::UnitZ()), Vec3(Vec3::UnitY()), Vec3(-Vec3::UnitY()), Vec3(-Vec3::UnitZ())}) {
        const Vec3 off = missing * (aside - ahead);
        if (free_share(stage, now, X_WB.p, X_WB.q * Vec3(camera.position + off)) < 1) continue;
        out.position += off;
        out.target += off;
        break;
      }
    }
  return out;
}

}  // namespace render
