// One step of the scheme, eq. (62) to (66): engine/README.md walks through it.
#pragma once

#include "engine/step/impact.h"
#include "engine/step/integration.h"
#include "engine/step_context.h"

namespace engine {

class StepControl;
struct Verdict;

class Stepper {
 public:
  explicit Stepper(World&, OnImpulses = {});

  /// Advances by at most h; returns the time taken, which is shorter when the step was cut or divided.
  double advance(State&, double h);

  /// The conditions that acted over the last step.
  const std::vector<Constraint>& conditions() const { return buffers_.constraints; }

 private:
  void find_contacts_at_start(State&);
  Verdict attempt(State&, StepControl&, std::optional<StepContext>&);
  void commit(StepContext&, const CompliantContacts::Crossing*);

  World& world_;
  OnImpulses on_impulses_;
  StepBuffers buffers_;
  Integration motion_;
  bool friction_varies_;  // with time or place
};

}  // namespace engine
