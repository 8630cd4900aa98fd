// What the necks of persons carry while their heads are struck. Joints do not give way along a neck, so all of the body stands
// behind a head that is struck crown first: a real neck would fail, and the head criteria of such a blow are of another blow.
#pragma once

#include <string>
#include <vector>

#include "engine/world.h"

namespace engine {

class NeckWatch {
 public:
  explicit NeckWatch(const World&);

  /// A contact just solved.
  void note(const World&, const Constraint&);

  /// At the end of a step, or of a part of one.
  void follow(const World&, const State&);

  /// At the end of the run: a warning for each neck that carried too much.
  void close(const World&, std::vector<std::string>& warnings) const;

 private:
  /// Of one person: a stretch of 3 ms from the first push on.
  struct Stretch {
    bool pushed = false;
    double since = 0;              // [s]
    Vec3 velocity = Vec3::Zero();  // [m/s] of the head, then
    Vec3 impulse = Vec3::Zero();   // [N s] of contacts on the head, meanwhile
    double force = 0, time = 0;    // [N], [s] most of all stretches
  };
  std::vector<Stretch> of_person_;  // none where nobody yields: a rigid blow has no force
};

}  // namespace engine
