// Watches what happens to persons: first touches of vehicle, head and ground, and wheels that run over them.
#pragma once

#include <vector>

#include "engine/world.h"

namespace engine {

class EventWatch {
 public:
  EventWatch(const World&, const State&);

  /// A contact that has acted from a time [s] on, for as long [s].
  void watch(const World&, const Constraint&, double time, double duration);

  /// At the end of every step.
  void watch_step(const World&, const State&);

  /// In the order in which they were seen.
  const std::vector<Event>& events() const { return events_; }

 private:
  void keep(const World&, const State&);
  void list_lying(const World&, const State&);
  void watch_vehicle(const World&, const Constraint&, int person, double time, double duration);
  void watch_ground(const Constraint&, int person, double time);
  void note(const char* kind, const Constraint&, double time);
  void note_head(const Constraint&, double time);

  std::vector<Event> events_;
  std::vector<char> of_trunk_;                             // per body
  std::vector<char> hit_vehicle_, hit_head_, hit_ground_;  // per person
  std::vector<char> run_over_;                             // per person and vehicle
  std::vector<double> least_load_;                         // [N] per vehicle: at rest, of its wheels
  std::vector<char> lying_;                                // per person: lay on its trunk at the start, or when it was struck
  std::vector<double> last_ground_, last_trunk_;           // [s] per person: last time on the ground, and with its trunk
  double watched_ = 0;                                     // [s] the last step
  std::vector<BodyState> before_;                          // per body, at its end
  long kept_ = 0;                                          // StillBodies::changes then
  std::vector<int> lying_on_;                              // persons who wait or sleep, and lay on the ground when they began to
  long listed_ = -1;                                       // StillBodies::changes when those were listed
};

}  // namespace engine
