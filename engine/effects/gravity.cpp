#include <algorithm>
#include <numbers>

#include "engine/effects/effects.h"
#include "engine/effects/words.h"
#include "engine/math/functions.h"

namespace engine {
namespace {

Finding look(const Model& model) {
  std::size_t moving = 0;
  double mass = 0;
  for (const Body& body : model.bodies) {
    if (body.fixed) continue;
    ++moving;
    mass += body.mass;
  }
  const Vec3& g = model.settings.gravity;
  if (moving == 0) return {false, "no body that can move", ""};
  if (g.squaredNorm() == 0) return {false, "simulation.gravity is 0", ""};
  std::string reason = number(g.norm()) + " m/s^2 on " + counted(moving, "body", "bodies") + ", " + number(mass) + " kg together";
  const double slope = math::acos(std::clamp(-g.normalized().z(), -1.0, 1.0)) * 180 / std::numbers::pi;
  if (slope > 1e-3) reason += "; the ground slopes by " + number(slope) + " deg";
  return {true, reason, ""};
}

void add_forces(const World& world, const std::vector<Pose>&, const std::vector<Twist>&, std::vector<Vec6>& force, int) {
  for (const int tree : world.active_trees)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int b = world.topology.links[l].body;
      force[b].head<3>() += world.model.bodies[b].mass * world.model.settings.gravity;
    }
}

}  // namespace

const Effect kGravityEffect{.name = "gravity", .look = look, .add_forces = add_forces};

}  // namespace engine
