// Hyper-ellipsoids of different persons, or free bodies, against each other.
#include "engine/effects/body_pairs.h"
#include "engine/effects/registration.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

Finding look_for_body_contact(const Model& model) {
  const std::size_t count = count_pairs_between_bodies(model);
  if (count > 0)
    return {true, counted(count, "pair") + " of segments or free bodies that are not one person's: " + round_bodies(model),
            "only pairs farther apart than a step can bring them together"};
  const std::string round = round_bodies(model);
  if (round.empty()) return {false, "no person and no free body", ""};
  return {false,
          model.persons.size() == 1 ? "one person alone; its own segments meet by self_contact" : "no second one to meet: " + round,
          ""};
}

}  // namespace

class BodyContact final : public Effect {
 public:
  static constexpr const char* kName = "body_contact";
  static Finding look(const Model& model) { return look_for_body_contact(model); }
  static double not_before(const Reach& reach) { return reach.groups_are_simple ? reach.first_touch : 0; }
  static bool gives(const Model& model) { return model.settings.contact_law != ContactLaw::default_auto; }

  BodyContact(World& world, int self) : Effect(self) { add_runs_between_bodies(world, self); }

  void find_contacts(ContactSearch& search) override { find_pair_contacts(search, rounds_, self_); }

 private:
  const PairKind& rounds_ = pair_kind({ShapeKind::round, ShapeKind::round});
};
template struct Registered<BodyContact>;

}  // namespace engine
