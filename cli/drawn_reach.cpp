#include "cli/drawn_reach.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "engine/geometry/hyper_ellipsoid.h"

namespace cli {
namespace {

using engine::Vec3;

/// Points [m], body axes, of a vehicle's picture beyond the box of its collision mesh.
std::vector<Vec3> beyond_collision(const render::MeshActor& actor) {
  constexpr double kBeyond = 0.02, kSpacing = 0.04;  // [m]
  std::map<std::array<long, 3>, Vec3> spread;
  const engine::Aabb box = actor.solid->bounds();
  const std::vector<float>& all = actor.mesh->positions;
  for (std::size_t i = 0; i + 2 < all.size(); i += 3) {
    const Vec3 p(all[i], all[i + 1], all[i + 2]);
    // above and beneath are aerials and exhausts
    const bool beyond =
        (p.array() < box.lower.array() - kBeyond).head<2>().any() || (p.array() > box.upper.array() + kBeyond).head<2>().any();
    if (!beyond) continue;
    const auto cell = [&](int k) { return std::lround(p[k] / kSpacing); };
    spread.try_emplace({cell(0), cell(1), cell(2)}, actor.X_BM * p);
  }
  std::vector<Vec3> out;
  for (const auto& [cell, p] : spread) out.push_back(p);
  return out;
}

/// The part that one of the points is in, -1: none.
int part_reached(const engine::Model& model, const engine::Person& person, const engine::Snapshot& s, const engine::Pose& X_WB,
                 const std::vector<Vec3>& points) {
  constexpr double kNear = 0.9;  // [-] of the part: what only brushes clothes is none
  for (const int b : person.bodies) {
    const auto& shape = std::get<engine::HyperEllipsoid>(model.bodies[static_cast<std::size_t>(b)].shape);
    const engine::Pose X_SB = s.bodies[static_cast<std::size_t>(b)].X_WB.inverse() * X_WB;
    if (std::any_of(points.begin(), points.end(), [&](const Vec3& p) { return gauge(shape, X_SB * p) < kNear; })) return b;
  }
  return -1;
}

bool is_touched(const engine::Person& person, const engine::Snapshot& s) {
  const auto own = [&](int body) { return std::find(person.bodies.begin(), person.bodies.end(), body) != person.bodies.end(); };
  return std::any_of(s.contacts.begin(), s.contacts.end(),
                     [&](const engine::ContactRecord& c) { return c.body_b >= 0 && own(c.body_a) != own(c.body_b); });
}

}  // namespace

std::vector<std::string> drawn_reaches(const scenes::Scene& scene, const engine::Recording& recording) {
  constexpr double kFar = 2;  // [m] beyond the box, for limbs
  const engine::Model& model = scene.model;
  std::vector<std::string> out;
  for (const render::MeshActor& actor : scene.stage.meshes) {
    if (actor.body < 0 || !actor.mesh || !actor.solid || model.bodies[static_cast<std::size_t>(actor.body)].vehicle < 0) continue;
    const std::vector<Vec3> points = beyond_collision(actor);
    const double reach = actor.solid->bounds().lower.cwiseAbs().cwiseMax(actor.solid->bounds().upper.cwiseAbs()).norm() + kFar;
    for (const engine::Person& person : model.persons) {
      if (points.empty() || person.mount == actor.body) continue;
      for (const engine::Snapshot& s : recording.snapshots) {
        if (is_touched(person, s)) break;
        const engine::Pose& X_WB = s.bodies[static_cast<std::size_t>(actor.body)].X_WB;
        if ((s.bodies[static_cast<std::size_t>(person.hips)].X_WB.p - X_WB.p).norm() > reach) continue;
        const int part = part_reached(model, person, s, X_WB, points);
        if (part < 0) continue;
        out.push_back(
            fmt::format("{} as drawn reaches {} at {:.3f} s, where nothing has touched {} yet: what stands out of its collision "
                        "mesh, as mirrors do, strikes nobody; what a real one does then is not in the run",
                        actor.name, model.bodies[static_cast<std::size_t>(part)].name, s.time, person.name));
        break;
      }
    }
  }
  return out;
}

}  // namespace cli
