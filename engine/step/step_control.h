// How long a step may be: what is known before it, and the verdict once it has been taken.
#pragma once

#include "engine/step/integration.h"
#include "engine/step_context.h"

namespace engine {

/// Of an attempt at a step.
struct Verdict {
  enum class Kind { go_on, again, place, ended } kind = Kind::go_on;
  double length = 0;  // [s] again, and to place an impact: of the next attempt
};

class StepControl {
 public:
  /// A step of at most `most` [s] from the state. Divided where a body turns fast or joint forces make a light one swing fast; ends
  /// at an instant that the state names.
  StepControl(World&, State&, double most);

  /// Divides the step where a head that yields is struck, by the contacts at its start.
  void follow_blows_on_heads();

  /// [s] to begin with.
  double length() const { return length_; }

  /// Where an impact with restitution comes within the step, it ends there. Returns the length to take.
  double cut_at_impact(const StepContext&);
  bool placing() const { return placing_; }

  /// What the spring of a compliant contact bears.
  Verdict bear_springs(const CompliantContacts&, double& length);

  /// After the smooth motion: does it follow the joints, and the error of scheme `adaptive`?
  Verdict judge_motion(const Swing&, double error, double length);

  /// Are events of compliant contacts still placed in this step?
  bool locates_events() const;
  void note_event() { crossed_ = true; }
  bool crossed() const { return crossed_; }

  /// After the impulses, with the contacts at the end: is what the step leaves acceptable?
  Verdict judge_end(StepContext&);

  /// The step is taken: what it says of the next.
  void accept(const StepContext&);

 private:
  Verdict end_run(int body, const char* effect, const char* message);
  bool find_crossing(const StepContext&);
  Verdict place_impact(const StepContext&);
  Verdict place_slip_end(const StepContext&);

  World& world_;
  State& state_;
  const Settings& settings_;
  const double shortest_;                  // [s]
  const double depth_tolerance_;           // [m] what a step may add to a penetration
  double length_ = 0;                      // [s]
  double error_ = 0;                       // [m] of the smooth motion
  bool placing_ = false;                   // impacts are still placed inside this step
  bool cut_ = false;                       // the step ends at one
  std::uint64_t striking_ = 0;             // the contact that makes it
  double uncut_ = 0;                       // [s] the step without it
  double placed_ = 0;                      // [s] the attempt that shall end right at it
  int placings_ = 0;                       // such attempts
  std::optional<std::uint64_t> stopping_;  // the contact whose slip ends there
  bool may_halve_ = false;
  double least_mislaid_ = std::numeric_limits<double>::infinity();  // [J] of attempts with nothing wrong but their books
  double least_mislaid_length_ = 0;                                 // [s] of that attempt
  bool settled_ = false;                                            // taken again as it is
  bool crossed_ = false;                                            // it ends at an event of a compliant contact
};

}  // namespace engine
