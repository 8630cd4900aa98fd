#include "engine/contact/pair_table.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace engine {
namespace {

enum class Stiffness { of_one_patch, of_each_point };

template <ShapeKind a, ShapeKind b>
constexpr PairKind row(const char* name, Stiffness stiffness = Stiffness::of_one_patch, bool one_person = false) {
  return {{a, b, one_person}, name, stiffness == Stiffness::of_one_patch, touches_between<a, b>};
}

using enum ShapeKind;

// Upright on ground, on a mesh or on a body a wheel is its suspension's (effects/tyres.cpp); what it meets otherwise is here.
constexpr std::array kTable = {
    row<round, plane>("ground"),
    row<round, terrain>("terrain"),
    row<round, mesh>("vehicle"),
    row<round, tyre>("vehicle"),
    row<round, round>("person"),
    row<round, round>("self", Stiffness::of_one_patch, true),
    row<mesh, plane>("ground", Stiffness::of_each_point),
    row<mesh, terrain>("terrain", Stiffness::of_each_point),
    row<mesh, mesh>("vehicle_pair", Stiffness::of_each_point),
    row<tyre, tyre>("vehicle_pair", Stiffness::of_each_point),
};

}  // namespace

std::span<const PairKind> pair_table() {
  return kTable;
}

const PairKind& pair_kind(const ShapePair& shapes) {
  const auto found = std::find_if(kTable.begin(), kTable.end(), [&](const PairKind& kind) { return kind.shapes == shapes; });
  assert(found != kTable.end() && "shapes that can meet have a row");
  return *found;
}

}  // namespace engine
