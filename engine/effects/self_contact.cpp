// Segments of one person against each other, jointed pairs and pairs that overlap in the start pose left out.
#include "engine/effects/body_pairs.h"
#include "engine/effects/effects.h"

namespace engine {
namespace {

std::optional<std::string> called_for(const Model& model) {
  const std::size_t count = pairs_within_persons(model, 0).size();
  if (count == 0) return std::nullopt;
  return std::to_string(count) + " pairs of segments of one person are not joined";
}

void begin(World& world, const State&, int self) {
  for (const BodyPair& pair : pairs_within_persons(world.model, self)) world.body_pairs.push_back(pair);
}

void find(World& world, const State& state, int self) {
  find_pair_contacts(world, state, self, ContactKind::self);
}

}  // namespace

const Effect kSelfContactEffect{.name = "self_contact", .called_for = called_for, .begin = begin, .find_contacts = find};

}  // namespace engine
