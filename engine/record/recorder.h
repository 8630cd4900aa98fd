// Collects what happens between snapshots, so that no impulse is lost between two rows of contacts.csv.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/record/accelerometers.h"
#include "engine/record/bounds_watch.h"
#include "engine/record/energy_watch.h"
#include "engine/record/event_watch.h"
#include "engine/record/neck_watch.h"
#include "engine/record/rest_watch.h"
#include "engine/world.h"

namespace engine {

class Recorder {
 public:
  Recorder(const World&, const State&);

  /// Adds the impulses of the constraints just solved. `duration` [s] of the step, 0 for an instantaneous exchange.
  void tally(const World&, const std::vector<Constraint>&, double time, double duration);

  /// End of every step: what snapshots are too seldom for.
  void sample(const World&, const State&, Recording&);
  /// At the end of every part of a divided step but the last; `left` [s] of it.
  void follow(const World&, const State&, double left, Recording&);

  /// Writes a snapshot with everything tallied since the one before.
  void snapshot(const World&, const State&, Recording&);

  /// Events that only the whole run tells (who came to rest when), and the closing diagnostics.
  void finish(const World&, const State&, Recording&);

  bool all_at_rest(const World& world, const State& state, const Recording& recording) const {
    return rest_.all_at_rest(world, state, recording);
  }

 private:
  struct Tally {
    std::uint64_t key;
    ContactRecord record;
    double duration = 0;
    Vec3 impulse = Vec3::Zero();
  };
  void tally_contact(const World&, const Constraint&, double time, double duration);
  void write_contacts(const World&, double since, std::vector<ContactRecord>&);
  void keep_still(const World&, const State&);
  Energies energies(const World&, const State&);

  RestWatch rest_;
  EventWatch events_;
  BoundsWatch bounds_;
  EnergyWatch energy_;
  NeckWatch necks_;
  Accelerometers accelerometers_;
  std::vector<Tally> tallies_;      // sorted by key
  std::size_t exchanges_told_ = 0;  // of RunLog::exchanges
  std::vector<Vec3> tyre_impulse_;  // [N s] world, per vehicle, since the last snapshot
  // at the last snapshot:
  long shared_ = -1;                          // StillBodies::changes
  std::shared_ptr<BodyStates::Still> still_;  // who is still
  std::vector<double> weight_;                // [J] per body: mass times gravity times place
};

}  // namespace engine
