// Watches the energy ledger over a run: what it cannot explain, and effects that give what they have not.
#pragma once

#include "engine/world.h"

namespace engine {

class EnergyWatch {
 public:
  /// At every snapshot.
  void weigh(const World&, const State&, const Energies&);

  /// At the end of the run: its figures, and warnings of what is more than 1 % of what was turned over. Of what nothing explains,
  /// also of more than 10 J that are more than 0.1 %.
  void close(const World&, Diagnostics&) const;

 private:
  void tell_of_gifts(const World&, Diagnostics&) const;

  bool begun_ = false;
  double mechanical_ = 0;                               // [J] at the last snapshot, without what sources put in
  double rise_ = 0;                                     // [J] largest between two snapshots
  double scale_ = 0;                                    // [J] of the scene
  double turned_over_ = 0;                              // [J] most at a snapshot: in motion, given off or put in
  double unexplained_ = 0;                              // [J] most at a snapshot, of either sign
  double at_ = 0;                                       // [s] when that was
  double stored_ = 0;                                   // [J] in the springs of joints at the start
  std::vector<double> dissipated_before_, dissipated_;  // [J] by effect at the first and the last snapshot
};

}  // namespace engine
