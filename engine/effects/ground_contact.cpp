// Segments and free bodies on the ground plane, eq. (70) to (74).
#include <algorithm>

#include "engine/effects/effects.h"
#include "engine/geometry/hyper_ellipsoid_plane.h"

namespace engine {
namespace {

bool has_surface(const Body& body) {
  return !body.fixed && std::holds_alternative<HyperEllipsoid>(body.shape);
}

std::optional<std::string> called_for(const Model& model) {
  const auto count = std::count_if(model.bodies.begin(), model.bodies.end(), has_surface);
  if (!model.ground.plane || count == 0) return std::nullopt;
  return "a ground plane and " + std::to_string(count) + " hyper-ellipsoids that can reach it";
}

void find(World& world, const State& state, int self) {
  const Ground& ground = world.model.ground;
  ContactPoints touches;
  for (int b = 0; b < static_cast<int>(world.model.bodies.size()); ++b) {
    const Body& body = world.model.bodies[b];
    if (!world.awake[b]) continue;
    const auto* shape = std::get_if<HyperEllipsoid>(&body.shape);
    if (!shape) continue;
    const double margin = contact_margin(world, state, b);
    if (state.X_WB[b].p.z() - ground.height > world.reach[b] + margin) continue;
    contacts_with_plane(*shape, state.X_WB[b], Vec3::UnitZ(), ground.height, margin, touches);
    const double t = state.time;
    const double e = std::max(body.surface.restitution_ground.at(t), ground.surface.restitution_ground.at(t));
    for (const SurfaceContact& touch : touches) {
      const double mu = std::min(body.surface.friction_ground.at(t), ground.friction_at(touch.p_b, t));
      add_contact(world, state, touch, b, -1, self, ContactKind::ground, mu, e);
    }
  }
}

}  // namespace

const Effect kGroundContactEffect{.name = "ground_contact", .called_for = called_for, .find_contacts = find};

}  // namespace engine
