#include "engine/effects/support.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "engine/effects/reach.h"
#include "engine/geometry/hyper_ellipsoid_mesh.h"
#include "engine/geometry/hyper_ellipsoid_pair.h"

namespace engine {
namespace {

constexpr double kUnder = 0.05;  // [m] `check` tells of who hovers higher (kHovers), and reach_of lets nothing wait within it

/// The place [m, world] of a body that bears a round part from so near; nothing where none does.
std::optional<Vec3> bearing_place(const Body& part, const Body& on) {
  const auto& round = std::get<HyperEllipsoid>(part.shape);
  ContactPoints touches;
  if (const auto* mesh = std::get_if<MeshShape>(&on.shape)) {
    MeshContactScratch scratch;
    contacts_with_mesh(round, part.X_WB, *mesh->mesh, on.X_WB * mesh->X_BM, kUnder, -std::numeric_limits<double>::infinity(),
                       scratch, touches);
  } else if (const auto* other = std::get_if<HyperEllipsoid>(&on.shape)) {
    Vec3 normal = Vec3::Zero();
    if (const auto touch = contact_of_pair(round, part.X_WB, *other, on.X_WB, kUnder, normal)) touches.push_back(*touch);
  }
  const auto bearing = std::find_if(touches.begin(), touches.end(), [](const SurfaceContact& t) { return t.normal.z() > kBears; });
  return bearing == touches.end() ? std::nullopt : std::optional<Vec3>(bearing->p_b);
}

/// What `bearing_place` can find is within these boxes.
bool could_bear(const Aabb& part, const Aabb& on) {
  return (on.upper.array() + kUnder >= part.lower.array()).all() && (part.upper.array() + kUnder >= on.lower.array()).all();
}

bool holds_on(const Model& model, int person, int body) {
  return std::any_of(model.joints.begin(), model.joints.end(), [&](const Joint& j) {
    const auto own = [&](int b) { return b >= 0 && model.bodies[b].person == person; };
    return (j.child == body && own(j.parent)) || (j.parent == body && own(j.child));
  });
}

/// Those of one person; empty where something that stands fast bears it.
std::vector<StoodOn> supports_of(const Model& model, int p, const std::vector<Aabb>& boxes) {
  std::vector<StoodOn> out;
  for (const int b : model.persons[p].bodies) {
    const Body& part = model.bodies[b];
    if (!is_round(part)) continue;
    const auto ground = model.ground.height_below(part.X_WB.p);
    if (ground && boxes[b].lower.z() - *ground < kUnder) return {};
    for (int o = 0; o < static_cast<int>(model.bodies.size()); ++o) {
      const Body& on = model.bodies[o];
      if (on.person == p || !could_bear(boxes[b], boxes[o]) || holds_on(model, p, o)) continue;
      const auto place = bearing_place(part, on);
      if (place && on.fixed) return {};
      if (place) out.push_back({p, b, o, on.X_WB.inverse() * *place});
    }
  }
  return out;
}

}  // namespace

std::vector<StoodOn> supports_at_start(const Model& model) {
  std::vector<StoodOn> out;
  std::vector<Aabb> boxes;
  for (const Body& body : model.bodies) boxes.push_back(box_at_start(body));
  for (int p = 0; p < static_cast<int>(model.persons.size()); ++p) {
    if (!model.persons[p].zero_condition || model.persons[p].mount >= 0) continue;
    const std::vector<StoodOn> of_person = supports_of(model, p, boxes);
    out.insert(out.end(), of_person.begin(), of_person.end());
  }
  return out;
}

bool moves_from_under(const Model& model, const Motion& at, int person, int on, const Vec3& place) {
  constexpr double kSlip = 0.1;  // [m/s]
  const Twist& V = at.V_WB[on];
  const Vec3 under = V.v + V.w.cross(place - at.X_WB[on].p);
  const Vec3 own = at.V_WB[model.persons[person].bodies.front()].v;
  return under.head<2>().norm() > kSlip && (under - own).head<2>().norm() > kSlip;
}

}  // namespace engine
