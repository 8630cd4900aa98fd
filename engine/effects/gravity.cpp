#include <algorithm>
#include <numbers>

#include "engine/effects/registration.h"
#include "engine/effects/words.h"
#include "engine/math/functions.h"

namespace engine {
namespace {

Finding look_for_gravity(const Model& model) {
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

}  // namespace

class Gravity final : public Effect {
 public:
  static constexpr const char* kName = "gravity";
  static Finding look(const Model& model) { return look_for_gravity(model); }
  static double not_before(const Model&, const Reach& reach) { return reach.all_bodies_wait ? reach.first_touch : 0; }

  Gravity(const World&, int self) : Effect(self) {}

  void add_forces(const World& world, std::span<const int> trees, const std::vector<Pose>&, const std::vector<Twist>&,
                  std::vector<Vec6>& force) const override {
    for_bodies_of(world, trees, [&](int b) { force[b].head<3>() += world.model.bodies[b].mass * world.model.settings.gravity; });
  }
};
template struct Registered<Gravity>;

}  // namespace engine
