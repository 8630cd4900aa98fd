// The run's own origin. Sites come in map coordinates, hundreds of kilometres from theirs, where a double resolves no more than
// 1e-10 m and every step would round to it; and what strikes and tumbles multiplies a difference by 1e8 in a second. A run counts
// from its first body, on a grid of 15 nm, so that a scene gives the same motion to the last bit wherever on the map it lies. One
// body by itself is its own origin and needs no grid.
#pragma once

#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

class LocalFrame {
 public:
  /// Takes x and y of the first body that moves.
  explicit LocalFrame(const Model&);

  /// The model counted from there, x and y of several rounded to 2^-26 m: what differs by less is the same scene.
  Model inwards(Model) const;

  /// The recording back in the scene's coordinates.
  void outwards(const Model&, Recording&) const;

 private:
  Vec3 origin_ = Vec3::Zero();  // [m]
  bool several_ = false;        // bodies move
};

}  // namespace engine
