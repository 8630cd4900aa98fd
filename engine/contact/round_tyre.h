// Wheels and the round bodies they may run over or into. The body (a) beside the tyre (b), where the strut has moved it to, is the
// row of the pair table; beneath it, it is what the suspension stands on.
#pragma once

#include <optional>
#include <vector>

#include "engine/contact/contact.h"
#include "engine/geometry/hyper_ellipsoid_tyre.h"

namespace engine {

/// All wheels with all segments and free bodies that do not ride on them.
std::vector<TyrePair> tyre_pairs(const Model&);

/// Spheres about the two, with the ways of the strut: near enough to look?
bool near(const Outlook&, const TyrePair&, double margin);

/// The suspension's compression [m], from static ride, at which the tyre just stands on the body: beneath it, no higher than the
/// stop lets it. Nothing where the two meet sideways, or that is below `least` [m].
std::optional<TyreTouch> stands_on(const Outlook&, const TyrePair&, double least);

}  // namespace engine
