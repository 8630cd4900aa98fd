#include "engine/effects/effects.h"

namespace engine {
namespace {

std::optional<std::string> called_for(const Model& model) {
  if (model.settings.gravity.squaredNorm() == 0 || model.bodies.empty()) return std::nullopt;
  return "gravity is not zero and there are bodies";
}

void add_forces(const World& world, const std::vector<Pose>&, const std::vector<Twist>&, std::vector<Vec6>& force, int) {
  for (const int tree : world.active_trees)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int b = world.topology.links[l].body;
      force[b].head<3>() += world.model.bodies[b].mass * world.model.settings.gravity;
    }
}

}  // namespace

const Effect kGravityEffect{.name = "gravity", .called_for = called_for, .add_forces = add_forces};

}  // namespace engine
