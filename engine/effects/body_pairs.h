// What self contact and contact between persons or free bodies share: pairs of hyper-ellipsoids.
#pragma once

#include <optional>

#include "engine/effects/effect.h"

namespace engine {

/// Pairs that may touch: both hyper-ellipsoids, not joined by a joint, not overlapping in the start pose by their nature.
std::vector<BodyPair> pairs_within_persons(const Model&);
std::size_t count_pairs_between_bodies(const Model&);

/// Adds the pairs within each person, listed, to the runs of the world.
void add_pairs_within_persons(World&, int effect);

/// Adds runs of all trees whose bodies may touch without being one person's.
void add_runs_between_bodies(World&, int effect);

/// Lists the pairs of such a run, bodies of lower index first, if that was not done yet, and makes room for their memory.
void list_pairs(World&, std::size_t run, std::vector<PairMemory>&);

/// The distance [m] a step can bring the two together by; nothing where they are farther apart.
std::optional<double> margin_of_near(const Outlook&, const BodyPair&);

void find_pair_contacts(ContactSearch&, int effect);

}  // namespace engine
