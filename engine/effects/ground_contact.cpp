// Segments and free bodies on the ground plane, eq. (70) to (74).
#include <algorithm>
#include <limits>

#include "engine/effects/registration.h"
#include "engine/effects/words.h"
#include "engine/geometry/hyper_ellipsoid_plane.h"

namespace engine {
namespace {

Finding look_at(const Model& model) {
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

}  // namespace

class GroundContact final : public Effect {
 public:
  static constexpr const char* kName = "ground_contact";
  static Finding look(const Model& model) { return look_at(model); }
  static bool gives(const Model& model) { return model.settings.contact_law != ContactLaw::default_auto; }

  GroundContact(const World&, int self) : Effect(self) {}

  void find_contacts(ContactSearch& search) override {
    const World& world = search.world;
    const Ground& ground = world.model.ground;
    const double t = search.at.time;
    ContactPoints touches;
    for (int b = 0; b < static_cast<int>(world.model.bodies.size()); ++b) {
      const Body& body = world.model.bodies[b];
      if (!world.awake[b]) continue;
      const auto* shape = std::get_if<HyperEllipsoid>(&body.shape);
      if (!shape) continue;
      const Pose& X = search.at.X_WB[b];
      const double margin = contact_margin(search, b);
      if (X.p.z() - ground.height > world.reach[b] + margin) continue;
      contacts_with_plane(*shape, X, Vec3::UnitZ(), ground.height, margin, touches);
      const double e = restitution_on_ground(body, ground, t);
      const std::size_t first = search.found.size();
      for (const SurfaceContact& touch : touches)
        add_contact(search, touch, b, kPlane, self_, {friction_on_ground(body, ground, touch.p_b, t), e});
      share_stiffness(search, first);
    }
  }
};
template struct Registered<GroundContact>;

}  // namespace engine
