// What self contact and contact between persons or free bodies share: pairs of hyper-ellipsoids.
#pragma once

#include "engine/effects/effect.h"

namespace engine {

/// Pairs that may touch: both hyper-ellipsoids, not joined by a joint, not overlapping in the start pose by their nature.
std::vector<BodyPair> pairs_within_persons(const Model&);
std::size_t count_pairs_between_bodies(const Model&);
/// Of the same, those that never meet because a joint holds them.
std::size_t count_pairs_held(const Model&);

/// Adds the pairs within each person, listed, to the runs of the world.
void add_pairs_within_persons(World&, int effect);

/// Adds runs of all trees whose bodies may touch without being one person's.
void add_runs_between_bodies(World&, int effect);

/// Lists the pairs of such a run, bodies of lower index first, if that was not done yet, and makes room for their memory.
void list_pairs(World&, std::size_t run, std::vector<PairMemory>&);

void find_pair_contacts(ContactSearch&, const PairKind&, int effect);

}  // namespace engine
