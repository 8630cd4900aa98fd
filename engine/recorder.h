// Collects what happens between snapshots, so that no impulse is lost between two rows of contacts.csv.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/energy_watch.h"
#include "engine/world.h"

namespace engine {

/// How a body moves over the ground. A vehicle may go on rocking on its springs where it has stopped: of one that is on its wheels
/// the motion of the point at the road under its centre, along the road, and the yaw. Of all else its whole motion.
Twist travel_of(const Model&, int body, const Pose&, const Twist&);

class Recorder {
 public:
  Recorder(const World&, const State&);

  /// Adds the impulses of the constraints just solved. `duration` [s] of the step, 0 for an instantaneous exchange.
  void tally(const World&, const std::vector<Constraint>&, double time, double duration);

  /// End of every step: what snapshots are too seldom for.
  void sample(const World&, const State&, Recording&);

  /// Writes a snapshot with everything tallied since the one before.
  void snapshot(const World&, const State&, Recording&);

  /// Events that only the whole run tells (who came to rest when), and the closing diagnostics.
  void finish(const World&, const State&, Recording&);

  /// True once everything that can move has been still for a while.
  bool all_at_rest(const World&, const State&) const;

 private:
  static constexpr double kStillTime = 0.25;   // [s] that long below both speeds of rest: at rest
  static constexpr double kToldInside = 2e-3;  // [m] rigid contacts and ends of slides: less than this is asked of every hard case
  struct Tally {
    std::uint64_t key;
    ContactRecord record;
    double duration = 0;
    Vec3 impulse = Vec3::Zero();
  };
  void tally_contact(const World&, const Constraint&, double time, double duration);
  void warn_of_shortfalls(const World&, std::vector<std::string>& warnings) const;
  void keep(const World&, const State&);
  void keep_still(const World&, const State&);
  double potential(const World&, const State&);
  void note_head(const Constraint&, double time);
  double travel_of_tree(const World&, const State&, std::size_t tree) const;
  void watch_rest(const World&, const State&, double since);
  void watch_halt(const World&, const State&);
  void watch_waiting(const State&);
  void list_parties(const World&, const State&);
  void watch_events(const World&, const Constraint&, double time);
  void watch_vehicle(const World&, const Constraint&, int person, double time);
  void watch_ground(const Constraint&, int person, double time);
  void note(const char* kind, const Constraint&, double time);
  void watch_bounds(const World&, const Constraint&, double time);
  void watch_compression(const Constraint&, double time, double duration);

  std::vector<Tally> tallies_;       // sorted by key
  std::vector<double> still_since_;  // [s] per tree, negative: moving
  std::vector<double> rest_since_;   // [s] the same of its trunk, if it has one
  std::vector<char> has_trunk_;      // per tree
  std::vector<double> halted_;       // [s] per tree: when it stopped, between recorded instants
  std::vector<double> motion_;       // [-] per tree at the last snapshot: fastest body by what counts as still
  std::vector<double> step_motion_;  // [-] the same at the last step, of trees of one body
  double watched_ = 0;               // [s] when that was
  std::vector<Event> events_;
  std::vector<char> hit_vehicle_, hit_head_, hit_ground_;  // per person
  std::vector<char> run_over_;                             // per person and vehicle
  std::vector<char> trunk_;                                // per body: of hips, head and what joins them
  std::vector<char> lying_;                                // per person: lay on its trunk at the start, or when it was struck
  std::vector<BodyState> before_;                          // per body, at the last sample
  std::vector<Vec3> tyre_impulse_;                         // [N s] world, per vehicle, since the last snapshot
  std::vector<double> last_ground_, last_trunk_;           // [s] per person: last time on the ground, and with its trunk
  std::size_t exchanges_told_ = 0;
  std::vector<Vec3> velocity_;  // [m/s] per body, at the last sample
  double sampled_ = 0;          // [s] when that was
  std::vector<double> times_;   // [s] of the samples of heads
  long kept_ = 0;               // StillBodies::changes then
  std::vector<int> alone_;      // trees of one body
  std::vector<int> moving_;     // persons who are not still
  std::vector<int> lying_on_;   // persons who wait or sleep, and lay on the ground when they began to
  long listed_ = -1;            // StillBodies::changes when those two were listed
  // at the last snapshot:
  long shared_ = -1;                          // StillBodies::changes
  std::shared_ptr<BodyStates::Still> still_;  // who is still
  std::vector<char> stirs_;                   // per tree: not all of its bodies are
  std::vector<double> weight_;                // [J] per body: mass times gravity times place
  EnergyWatch energy_;
  double compression_ = 0;  // [m] deepest of a compliant contact
  Shortfall too_deep_;      // [m] of a compliant contact, beyond its thickness
  Shortfall stood_inside_;  // [m] of a rigid contact
  Shortfall crossed_;       // [m] of two vehicles
  Shortfall overturned_;    // [rad] of a joint, beyond its range
  Shortfall overslid_;      // [m] the same of a slide
};

}  // namespace engine
