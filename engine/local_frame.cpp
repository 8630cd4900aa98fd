#include "engine/local_frame.h"

#include <algorithm>
#include <cmath>

namespace engine {
namespace {

/// Heights are small wherever a site lies, and are left as they are.
Vec3 rounded(const Vec3& p) {
  constexpr double kGrid = 0x1p26;  // [1/m]
  return {std::round(p.x() * kGrid) / kGrid, std::round(p.y() * kGrid) / kGrid, p.z()};
}

}  // namespace

LocalFrame::LocalFrame(const Model& model) {
  const auto moves = [](const Body& body) { return !body.fixed; };
  const auto first = std::find_if(model.bodies.begin(), model.bodies.end(), moves);
  if (first == model.bodies.end()) return;
  origin_ = {first->X_WB.p.x(), first->X_WB.p.y(), 0};
  several_ = std::any_of(first + 1, model.bodies.end(), moves);
}

Model LocalFrame::inwards(Model model) const {
  auto shift = [&](Vec3& p) { p = several_ ? rounded(p - origin_) : Vec3(p - origin_); };
  for (Body& body : model.bodies) shift(body.X_WB.p);
  for (Joint& joint : model.joints)
    if (joint.parent < 0) shift(joint.X_PF.p);
  for (ImpactSettings& impact : model.impacts)
    if (impact.point_W) shift(*impact.point_W);
  for (Vehicle& vehicle : model.vehicles)
    for (Vec3& point : vehicle.path.points) shift(point);
  for (GroundPatch& patch : model.ground.patches) {
    shift(patch.lower);
    shift(patch.upper);
  }
  if (model.ground.terrain && !origin_.isZero()) {
    std::vector<Vec3> vertices = model.ground.terrain->vertices();
    for (Vec3& v : vertices) shift(v);
    model.ground.terrain = std::make_shared<TriangleMesh>(std::move(vertices), model.ground.terrain->triangles());
  }
  return model;
}

void LocalFrame::outwards(const Model& model, Recording& recording) const {
  if (origin_.isZero()) return;
  double potential = 0;  // [J] what the shift is worth where gravity is not along z
  for (const Body& body : model.bodies)
    if (!body.fixed) potential -= body.mass * model.settings.gravity.dot(origin_);
  const BodyStates::Still* moved = nullptr;
  const auto move = [this](std::vector<BodyState>& states) {
    for (BodyState& body : states) body.X_WB.p += origin_;
  };
  for (Snapshot& s : recording.snapshots) {
    s.energies.potential += potential;
    move(s.bodies.others());
    if (BodyStates::Still* still = s.bodies.still(); still && still != moved) move(still->states);
    moved = s.bodies.still();
    for (ContactRecord& c : s.contacts) c.point += origin_;
    for (WheelRecord& wheel : s.wheels) {
      wheel.hub += origin_;
      wheel.contact += origin_;
    }
  }
  for (Event& event : recording.events) event.point += origin_;
}

}  // namespace engine
