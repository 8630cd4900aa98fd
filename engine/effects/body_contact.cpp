// Hyper-ellipsoids of different persons, or free bodies, against each other.
#include "engine/effects/body_pairs.h"
#include "engine/effects/effects.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

Finding look(const Model& model) {
  const std::size_t count = count_pairs_between_bodies(model);
  if (count > 0)
    return {true, counted(count, "pair") + " of segments or free bodies that are not one person's: " + round_bodies(model),
            "pairs farther apart than they can travel in a step: exact"};
  const std::string round = round_bodies(model);
  if (round.empty()) return {false, "no person and no free body", ""};
  return {false,
          model.persons.size() == 1 ? "one person alone; its own segments meet by self_contact" : "no second one to meet: " + round,
          ""};
}

void begin(World& world, const State&, int self) {
  add_runs_between_bodies(world, self);
}

void find(World& world, const State& state, int self) {
  find_pair_contacts(world, state, self, ContactKind::person);
}

}  // namespace

const Effect kBodyContactEffect{.name = "body_contact", .look = look, .begin = begin, .find_contacts = find};

}  // namespace engine
