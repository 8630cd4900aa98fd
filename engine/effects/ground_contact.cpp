// Segments and free bodies on the ground plane, eq. (70) to (74).
#include <algorithm>
#include <limits>

#include "engine/effects/effects.h"
#include "engine/effects/words.h"
#include "engine/geometry/hyper_ellipsoid_plane.h"

namespace engine {
namespace {

Finding look(const Model& model) {
  const std::string round = round_bodies(model);
  if (!model.ground.plane) return {false, "no ground plane", ""};
  if (round.empty()) return {false, "no person and no free body; vehicles meet the ground by tyres and bodywork_contact", ""};
  double lowest = std::numeric_limits<double>::infinity();
  for (const Body& body : model.bodies)
    if (is_round(body) && !body.fixed)
      lowest = std::min(lowest, body.X_WB.p.z() - aabb_half_widths(std::get<HyperEllipsoid>(body.shape), body.X_WB.q).z());
  return {true, round + " over the plane; the lowest point starts " + height_in_words(lowest - model.ground.height),
          "bodies higher than a step can bring them down: exact"};
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
    const std::size_t first = world.constraints.size();
    for (const SurfaceContact& touch : touches) {
      const double mu = std::min(body.surface.friction_ground.at(t), ground.friction_at(touch.p_b, t));
      add_contact(world, state, touch, b, -1, self, ContactKind::ground, mu, e);
    }
    share_stiffness(world, first);
  }
}

}  // namespace

const Effect kGroundContactEffect{.name = "ground_contact", .look = look, .find_contacts = find};

}  // namespace engine
