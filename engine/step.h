// One step of scheme `stepping`, eq. (62) to (66): engine/README.md walks through it.
#pragma once

#include <functional>
#include <optional>

#include "engine/solver/smooth_motion.h"
#include "engine/world.h"

namespace engine {

/// Buffers of a step, sized once.
class Stepper {
 public:
  Stepper(World&);

  /// Advances by at most h; returns the time taken, which is shorter when the step was cut to place an impact.
  double advance(World&, State&, double h);

  /// Called whenever impulses have been exchanged, with the time and the length of the step (0: an instant).
  std::function<void(double time, double duration)> on_impulses;

 private:
  void reserve(const World&);
  void warn_of_overlaps(World&) const;
  void choose_trees(World&, const State&);
  double attempt(World&, State&, double h);
  static double stop(World&, const State&, int body, const char* effect, const char* message);
  double integrate(World&, const State&, double h);
  bool locate_contact_event(World&, const State&, double& taken, CompliantContacts::Crossing&);
  void find_contacts(World&, const State&, std::vector<Constraint>& found);
  void assemble_constraints(World&, const State&, double h);
  void push_apart(World&, const std::vector<int>& island, double h);
  bool acceptable(const std::vector<Constraint>& end) const;
  double largest_rise(const World&, const State& start, double h);
  double fastest_turning(const World&, const State&) const;
  double time_to_impact(World&, double h) const;
  void exchange_impulses(World&, State&, const std::vector<int>& members, double& energy_change);
  bool impact(World&, State&);
  void prepare_resistance(World&, const State&, double h);
  bool exchange_over_step(World&, State&, double h, double& residual);
  bool friction_gave_way(World&) const;
  void assemble_solver(World&, const std::vector<int>& members);
  void factor_for_impulses(World&, const State&, const std::vector<JointDamper>* dampers);
  void set_targets(World&, double h);
  void form_islands(World&);
  double solve_islands(World&, State&, double h);  // largest residual [m/s]
  double close_joints(World&);
  void keep_impulses(const World&, State&) const;
  void apply(World&, double h);
  void book(World&);
  void note_turning(World&, Vec3 Resistance::*when) const;
  void apply_resistance(World&, double h);
  double resistance_work(const World&, int joint, double h) const;
  double work_of(const World&, std::size_t constraint) const;
  void book_resistance(World&, double h);
  void drop_open_rows(World&, double h);

  SmoothMotion smooth_;
  std::optional<CompliantContacts> compliant_;  // contacts that act as forces in the stages
  std::vector<Twist> V_whole_;
  std::vector<Pose> X_whole_;  // adaptive: of the step taken in one
  State end_;                  // of the step
  std::vector<Pose>& X_ = end_.X_WB;
  std::vector<Twist>& V_ = end_.V_WB;
  std::vector<Twist> V_smooth_;  // before resistance and impulses
  std::vector<Pose> X_smooth_;
  std::vector<Constraint> step_constraints_;
  std::vector<double> allowed_;
  std::vector<int> members_;                         // that exchange impulses at an instant
  std::vector<double> targets_;                      // of those
  std::vector<Constraint> contacts_, end_contacts_;  // found at its start, at its end
  std::vector<int> contact_trees_;                   // trees awake when contacts_ were found
  bool contacts_known_ = false;
  double depth_tolerance_ = 1;  // [m] scheme adaptive: what a step may add to a penetration
  double next_step_ = 0;        // [s] what the last step suggests, 0: anything
  std::vector<Vec6> force_, displacing_, result_;
  std::vector<std::vector<int>> islands_;
  int unsettled_ = -1;  // constraint that the solver met worst, if not to its tolerance
  std::vector<char> island_has_impact_;
  std::vector<double> island_rise_;  // [J] per island
  std::vector<int> island_of_tree_;
  std::vector<double> weight_;  // per constraint: share of the step its displacement acts
  double turning_ = 0;          // [rad/s] of the fastest body
  int cuts_ = 0;                // of the step under way
  int events_ = 0;              // of compliant contacts placed in it
  bool locating_ = false;       // impacts are still placed inside this step
};

}  // namespace engine
