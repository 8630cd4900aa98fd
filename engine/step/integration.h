// The smooth motion over a step, in as many parts as it needs, and the places of its events.
#pragma once

#include <optional>
#include <span>

#include "engine/step/compliant_contacts.h"
#include "engine/step/smooth_motion.h"
#include "engine/step_context.h"

namespace engine {

/// How fast the joint forces of a step may make a body swing, over the step [-]: Runge-Kutta bears 2.8.
constexpr double kSmoothSwing = 2.0;
constexpr double kMostParts = 20;  // of the smooth motion in one step, and of a step by turning

/// Angular speed [rad/s] of the fastest body of some trees.
double fastest_turning(const World&, std::span<const int> trees, const Motion&);

class Integration {
 public:
  Integration(World&, StepBuffers&);

  /// What is touched within a step of this length: there two stages are enough.
  void note_touched(const StepContext&);

  /// The motion over `length` [s] to StepBuffers::end; with scheme `adaptive` in two halves, and returns the estimated error [m] of
  /// the one taken whole (Richardson: the halves are closer by 2^4).
  double advance(const State&, double length);

  /// Shortens a step taken to the first touch, turn or separation of a compliant contact; regula falsi (Illinois) on its length.
  /// False if there is none.
  bool locate_contact_event(const State&, double& length);

  Swing swing;                                 // of the last motion
  std::optional<CompliantContacts> compliant;  // contacts that act as forces in the stages
  CompliantContacts::Crossing crossing;        // the event located

 private:
  /// The smooth motion of some trees over a step: its parts, and the stages of each.
  struct Pace {
    int parts;
    Stages stages;
  };
  double fastest_precession(std::span<const int> trees, const Motion&) const;
  Pace pace(std::span<const int> trees, const State&, double length) const;
  void advance_over(const State&, double way, double length, FirstStage);
  double difference() const;

  World& world_;
  StepBuffers& buffers_;
  SmoothMotion smooth_;
  std::vector<double> middle_inertia_;  // [kg m^2] per body
  std::vector<char> touched_;           // per tree
  long copied_ = 0;                     // StillBodies::changes when all bodies were taken over
};

}  // namespace engine
