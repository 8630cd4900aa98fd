// Segments of one person against each other, jointed pairs and pairs that overlap in the start pose left out.
#include "engine/effects/body_pairs.h"
#include "engine/effects/registration.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

Finding look_for_self_contact(const Model& model) {
  if (model.persons.empty()) return {false, "no person", ""};
  const std::size_t count = pairs_within_persons(model).size();
  std::size_t all = 0, joined = 0;
  for (const Person& person : model.persons)
    for (std::size_t i = 0; i < person.bodies.size(); ++i)
      for (std::size_t k = i + 1; k < person.bodies.size(); ++k) {
        if (!is_round(model.bodies[person.bodies[i]]) || !is_round(model.bodies[person.bodies[k]])) continue;
        ++all;
        joined += jointed(model, person.bodies[i], person.bodies[k]);
      }
  const std::size_t overlapping = all - joined - count;
  std::string left_out = counted(joined, "pair") + " that a joint holds";
  if (overlapping > 0) left_out += ", " + counted(overlapping, "pair") + " inside each other in the start pose";
  if (count == 0) return {false, "no two segments of a person that could touch", left_out};
  return {true, counted(count, "pair") + " of segments of the same person, of " + std::to_string(all), left_out};
}

}  // namespace

class SelfContact final : public Effect {
 public:
  static constexpr const char* kName = "self_contact";
  static constexpr bool kPassive = true;
  static Finding look(const Model& model) { return look_for_self_contact(model); }
  static double not_before(const Model&, const Reach& reach) { return reach.all_joints_wait ? reach.first_touch : 0; }
  static bool gives(const Model& model) { return model.settings.contact_law != ContactLaw::default_auto; }

  SelfContact(World& world, int self) : Effect(self) { add_pairs_within_persons(world, self); }

  void find_contacts(ContactSearch& search) override { find_pair_contacts(search, rounds_, self_); }

 private:
  const PairKind& rounds_ = pair_kind({ShapeKind::round, ShapeKind::round, true});
};
template struct Registered<SelfContact>;

}  // namespace engine
