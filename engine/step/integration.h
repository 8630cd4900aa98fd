// The smooth motion over a step, in as many parts as it needs, and the places of its events.
#pragma once

#include <optional>

#include "engine/step/compliant_contacts.h"
#include "engine/step/smooth_motion.h"
#include "engine/step_context.h"

namespace engine {

class StepControl;

class Integration {
 public:
  Integration(World&, StepBuffers&);

  /// The motion over `length` [s] to StepBuffers::end; with scheme `adaptive` in two halves, and returns the estimated error [m] of
  /// the one taken whole (Richardson: the halves are closer by 2^4).
  double advance(const State&, const StepControl&, double length, Stages);

  /// How many stages a step of this length asks for: two where all that has joints is touched within it, as long as the control
  /// bears that.
  Stages stages(const StepContext&, const StepControl&);

  /// Shortens a step taken to the first touch, turn or separation of a compliant contact; regula falsi (Illinois) on its length.
  /// False if there is none.
  bool locate_contact_event(const State&, const StepControl&, double& length);

  SmoothMotion smooth;
  std::optional<CompliantContacts> compliant;  // contacts that act as forces in the stages
  CompliantContacts::Crossing crossing;        // the event located

 private:
  double difference() const;

  World& world_;
  StepBuffers& buffers_;
  std::vector<char> touched_;  // per tree
  long copied_ = 0;            // StillBodies::changes when all bodies were taken over
};

}  // namespace engine
