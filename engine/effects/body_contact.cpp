// Hyper-ellipsoids of different persons, or free bodies, against each other.
#include "engine/effects/body_pairs.h"
#include "engine/effects/effects.h"

namespace engine {
namespace {

std::optional<std::string> called_for(const Model& model) {
  const std::size_t count = pairs_between_bodies(model, 0).size();
  if (count == 0) return std::nullopt;
  return std::to_string(count) + " pairs of hyper-ellipsoids of different persons or bodies";
}

void begin(World& world, const State&, int self) {
  for (const BodyPair& pair : pairs_between_bodies(world.model, self)) world.body_pairs.push_back(pair);
}

void find(World& world, const State& state, int self) {
  find_pair_contacts(world, state, self, ContactKind::person);
}

}  // namespace

const Effect kBodyContactEffect{.name = "body_contact", .called_for = called_for, .begin = begin, .find_contacts = find};

}  // namespace engine
