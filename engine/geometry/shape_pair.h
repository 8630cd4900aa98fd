// Between which two shapes a contact is. What it is called, and what measures and pictures count it as, follow from that.
#pragma once

#include <tuple>

namespace engine {

/// What touches: a hyper-ellipsoid; a mesh, of a vehicle with the rims and flanks of its wheels; a tyre as one body; the ground.
enum class ShapeKind { round, mesh, tyre, plane, terrain };

struct ShapePair {
  ShapeKind a = ShapeKind::round;
  ShapeKind b = ShapeKind::plane;
  bool one_person = false;  // two segments of the same person

  constexpr bool on_ground() const { return b == ShapeKind::plane || b == ShapeKind::terrain; }
  /// A segment or free body on a vehicle or another mesh.
  constexpr bool on_vehicle() const { return a == ShapeKind::round && (b == ShapeKind::mesh || b == ShapeKind::tyre); }
  constexpr bool between_vehicles() const { return a != ShapeKind::round && !on_ground(); }
  constexpr bool with_vehicle() const { return on_vehicle() || between_vehicles(); }

  constexpr bool operator==(const ShapePair&) const = default;
  template <class S>
  static auto fields(S& s) {
    return std::tie(s.a, s.b, s.one_person);
  }
};

}  // namespace engine
