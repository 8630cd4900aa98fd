// The pair table: which shapes meet, what their contacts are called, and the function that finds them. A pair is a file in this
// folder and a line in pair_table.cpp. Broad phase and lists of pairs come before it, `add_contacts` of contact.h after it.
#pragma once

#include <cstddef>
#include <span>

#include "engine/contact/broad_phase.h"
#include "engine/geometry/shape_pair.h"
#include "engine/geometry/surface_contact.h"

namespace engine {

/// What stands for the ground in place of a second body.
constexpr int kPlane = -1, kTerrain = -2;

/// Two bodies whose surfaces may touch.
struct ContactPair {
  int a = 0, b = 0;     // b may be the plane or the terrain
  std::size_t at = 0;   // its place in the list of such pairs, where its contact memory is
  std::size_t run = 0;  // of rounds: of that run of them
};

/// Where two surfaces touch or nearly do, normals from b to a. Valid until the next look at any pair.
using Touches = std::span<const SurfaceContact>;

struct PairKind {
  ShapePair shapes;
  const char* name;  // of their contacts, as in contacts.csv
  bool one_patch;    // compliant law: the points share one surface's stiffness
  /// Cached separation and narrow phase. Of two meshes: the points of a on the surface of b.
  Touches (*touches)(const Outlook&, const ContactPair&);
};

/// Each pair defines its own, in a file of its own.
template <ShapeKind a, ShapeKind b>
Touches touches_between(const Outlook&, const ContactPair&);

std::span<const PairKind> pair_table();

/// The row of two shapes that can meet.
const PairKind& pair_kind(const ShapePair&);

}  // namespace engine
