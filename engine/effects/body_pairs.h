// What self contact and contact between persons or free bodies share: a list of pairs of hyper-ellipsoids.
#pragma once

#include "engine/effects/effect.h"

namespace engine {

/// Pairs that may touch: both hyper-ellipsoids, not joined by a joint, not overlapping in the start pose by their nature.
std::vector<BodyPair> pairs_within_persons(const Model&, int effect);
std::vector<BodyPair> pairs_between_bodies(const Model&, int effect);
std::size_t count_pairs_between_bodies(const Model&);

/// Appends them to those of the world.
void add_pairs(World&, std::vector<BodyPair>);

void find_pair_contacts(World&, const State&, int effect, ContactKind);

}  // namespace engine
