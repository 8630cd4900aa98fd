// Hyper-ellipsoids of different persons, or free bodies, against each other.
#include <algorithm>

#include "engine/effects/body_pairs.h"
#include "engine/effects/registration.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

/// "3 free bodies and 2 fixed ones".
std::string all_round_bodies(const Model& model) {
  std::string moving = round_bodies(model);
  const auto fixed = std::count_if(model.bodies.begin(), model.bodies.end(), [](const Body& b) { return b.fixed && is_round(b); });
  if (moving.empty() || fixed == 0) return moving;
  return moving + " and " + counted(static_cast<std::size_t>(fixed), "fixed one");
}

Finding look_for_body_contact(const Model& model) {
  const std::size_t count = count_pairs_between_bodies(model), held = count_pairs_held(model);
  const std::string round = all_round_bodies(model), by_joints = counted(held, "pair") + " that a joint holds";
  if (count > 0)
    return {true, counted(count, "pair") + " of segments or free bodies that are not one person's: " + round,
            "only pairs farther apart than a step can bring them together" + (held > 0 ? ", and " + by_joints : "")};
  if (round.empty()) return {false, "no person and no free body", ""};
  if (held > 0) return {false, "no two that no joint holds: " + round, by_joints};
  return {false,
          model.persons.size() == 1 ? "one person alone; its own segments meet by self_contact" : "no second one to meet: " + round,
          ""};
}

}  // namespace

class BodyContact final : public Effect {
 public:
  static constexpr const char* kName = "body_contact";
  static constexpr bool kPassive = true;
  static Finding look(const Model& model) { return look_for_body_contact(model); }
  static double not_before(const Model&, const Reach& reach) { return reach.groups_are_simple ? reach.first_touch : 0; }
  static bool gives(const Model& model) { return model.settings.contact_law != ContactLaw::default_auto; }

  BodyContact(World& world, int self) : Effect(self) { add_runs_between_bodies(world, self); }

  void find_contacts(ContactSearch& search) override { find_pair_contacts(search, rounds_, self_); }

 private:
  const PairKind& rounds_ = pair_kind({ShapeKind::round, ShapeKind::round});
};
template struct Registered<BodyContact>;

}  // namespace engine
