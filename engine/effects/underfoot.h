// What who walks or rides in the zero condition goes over: the plane is level; terrain and fixed meshes rise, fall and end.
#pragma once

#include <optional>
#include <vector>

#include "engine/contact/road.h"
#include "engine/state.h"

namespace engine {

/// Does anything but the plane carry who walks?
bool is_uneven(const Model&);

class Underfoot {
 public:
  explicit Underfoot(const Model&);

  bool level() const { return roads_.empty(); }
  /// Metres up by metre of the person's level way. A stride spans a kerb or a stair: the height is the mean over one, so that it
  /// rises by (h(ahead) - h(behind)) / stride. Nothing where the person has walked off an edge or into what is too high to mount.
  std::optional<double> rise(const Model&, const State&, int person) const;
  /// Is a point of a fixed mesh what a person who moves goes over: no higher than a step from the ground under it?
  bool carries(const Model&, const State&, int person, int mesh_body, const Vec3& point) const;

 private:
  /// Of the highest surface below a point [m]; far below where there is none.
  double height_below(const Ground&, const Vec3& from) const;
  /// By a wall or a bank.
  bool is_blocked(const Vec3& from, const Vec3& way) const;
  /// Of the lowest point of the person's figure over the ground below the hips [m].
  double clearance(const Model&, const std::vector<Pose>& X_WB, const Person&) const;

  std::vector<Road> roads_;
  std::vector<double> clearance_;  // [m] at the start, by persons: who stands on a moving deck is as high over the road as the deck
};

}  // namespace engine
