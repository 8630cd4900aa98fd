// Watches over a run when things come to rest.
#pragma once

#include <vector>

#include "engine/world.h"

namespace engine {

/// How a body moves over the ground. A vehicle may go on rocking on its springs where it has stopped: of one that is on its wheels
/// the motion of the point at the road under its centre, along the road, and the yaw. Of all else its whole motion.
Twist travel_of(const Model&, int body, const Pose&, const Twist&);

class RestWatch {
 public:
  explicit RestWatch(const World&);

  /// At the end of every step.
  void watch_step(const World&, const State&);

  /// At every snapshot, `since` [s] after the one before.
  void watch_snapshot(const World&, const State&, double since);

  /// True once everything that can move has been still for a while, and neither the clock nor what acts on it sets it in motion.
  bool all_at_rest(const World&, const State&, const Recording&) const;

  /// Appends who came to rest and when, at the end of the run.
  void tell(const World&, const State&, const Recording&, std::vector<Event>&) const;

 private:
  double travel_of_tree(const World&, const State&, std::size_t tree) const;
  bool tells_of(int body, std::size_t tree) const { return !has_trunk_[tree] || of_trunk_[body]; }

  /// Mean motions [-], by what counts as still, of the two halves of the last while, and how far they differ.
  struct Halves {
    double before = 0, after = 0, change = 0;
    /// Pulled from rest it has the threefold in the second half. `begins` [-]: a mean motion that is none of the solver's.
    bool grows(double begins) const;
  };
  Halves halves_of(const World&, const State&, const Recording&, std::size_t tree) const;
  bool goes_on(const World&, const State&, const Recording&, std::size_t tree) const;
  void list_stirring(const World&);

  std::vector<char> of_trunk_;       // per body
  std::vector<char> has_trunk_;      // per tree
  std::vector<int> alone_;           // trees of one body
  std::vector<char> stirs_;          // per tree: not all of its bodies are still
  long listed_ = -1;                 // StillBodies::changes when those were listed
  std::vector<double> still_since_;  // [s] per tree, negative: moving
  std::vector<double> rest_since_;   // [s] the same of its trunk, if it has one
  std::vector<double> halted_;       // [s] per tree: when it stopped, between recorded instants
  std::vector<double> motion_;       // [-] per tree at the last snapshot: fastest body by what counts as still
  std::vector<double> step_motion_;  // [-] the same at the last step, of trees of one body
  double watched_ = 0;               // [s] when that was
  double quiet_from_ = 0;            // [s] no act of a driver and no change of a surface comes later
};

}  // namespace engine
