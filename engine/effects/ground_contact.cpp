// Segments and free bodies on the ground plane.
#include <algorithm>
#include <limits>

#include "engine/effects/registration.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

Finding look_for_ground_contact(const Model& model) {
  const std::string round = round_bodies(model);
  if (!model.ground.plane) return {false, "no ground plane", ""};
  if (round.empty()) return {false, "no person and no free body; vehicles meet the ground by tyres and bodywork_contact", ""};
  double lowest = std::numeric_limits<double>::infinity();
  for (const Body& body : model.bodies)
    if (is_round(body) && !body.fixed)
      lowest = std::min(lowest, body.X_WB.p.z() - aabb_half_widths(std::get<HyperEllipsoid>(body.shape), body.X_WB.q).z());
  return {true, round + " over the plane; the lowest point starts " + height_in_words(lowest - model.ground.height),
          "only bodies higher than a step can bring them down"};
}

}  // namespace

class GroundContact final : public Effect {
 public:
  static constexpr const char* kName = "ground_contact";
  static constexpr bool kPassive = true;
  static Finding look(const Model& model) { return look_for_ground_contact(model); }
  static double not_before(const Model&, const Reach& reach) { return reach.all_rounds_wait ? reach.first_touch : 0; }
  static bool gives(const Model& model) { return model.settings.contact_law != ContactLaw::default_auto; }

  GroundContact(const World&, int self) : Effect(self) {}

  void find_contacts(ContactSearch& search) override {
    const World& world = search.world;
    if (!world.model.ground.plane) return;  // switched on by hand
    for (const int b : world.still.others)
      if (world.awake[b] && is_round(world.model.bodies[b])) add_contacts(search, plane_, {b, kPlane}, self_);
  }

 private:
  const PairKind& plane_ = pair_kind({ShapeKind::round, ShapeKind::plane});
};
template struct Registered<GroundContact>;

}  // namespace engine
