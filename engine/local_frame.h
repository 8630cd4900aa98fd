// The run's own origin. Sites come in map coordinates, hundreds of kilometres from theirs, where a double resolves no more than
// 1e-10 m and every step would round to it. A run counts from whole metres near its first body, so that a scene gives the same
// motion, to the last bit, wherever on the map it lies.
#pragma once

#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

class LocalFrame {
 public:
  /// Takes whole metres in x and y near the first body that moves.
  explicit LocalFrame(const Model&);

  /// The model counted from there. Places are rounded to 2^-35 m, which a double still holds 250 km away: what differs
  /// by less is the same scene.
  Model inwards(Model) const;

  /// The recording back in the scene's coordinates.
  void outwards(const Model&, Recording&) const;

 private:
  Vec3 origin_ = Vec3::Zero();  // [m]
};

}  // namespace engine
