// Motion under smooth forces and joints: classic fourth-order Runge-Kutta with full re-evaluation in each stage.
//
// The quaternion is integrated as a vector of four, dq/dt = 1/2 (0, w) q, and normalised once at the end: that keeps order four
// (an exponential map per stage with a summed w does not). Joint multipliers are solved anew in each stage with g = -Jdot V.
//
// What is touched follows its impulses to order one. There velocity Verlet, with what depends on velocity at that foretold for the
// end, takes half of the time and gives order two. A swing under joint forces neither gains nor loses by it.
#pragma once

#include <vector>

#include "engine/step/compliant_contacts.h"
#include "engine/world.h"

namespace engine {

/// Whether the first stage is where the step begins. What is factorised there serves the impulses too.
enum class FirstStage { within_step, where_it_begins };

/// Of a step: velocity Verlet has two, Runge-Kutta four.
enum class Stages { two = 2, four = 4 };

/// Buffers of one step, sized once.
class SmoothMotion {
 public:
  explicit SmoothMotion(const Model&);

  /// Advances the awake bodies by h from `state` under the plan's forces; results for awake bodies only.
  /// `compliant` (may be null) adds the forces of contacts in every stage, of which there must be four.
  void advance(World&, const Motion&, double h, std::vector<Pose>& X, std::vector<Twist>& V, Stages,
               CompliantContacts* compliant = nullptr, FirstStage first = FirstStage::within_step);

  /// Rate [rad/s] of the fastest swing that the joint forces of the last step make a body capable of: T r / I, as in a chain of
  /// light links pulled taut by heavy ends. Runge-Kutta 4 blows up above 2.8 over the step.
  double fastest_swing() const { return fastest_swing_; }
  /// As the last step of a run that goes on here left it.
  void recall(double fastest_swing, int body) { fastest_swing_ = fastest_swing, swinging_body_ = body; }
  /// The body capable of it; -1: none.
  int swinging_body() const { return swinging_body_; }

 private:
  struct Stage {
    std::vector<Vec6> a;  // dv, dw
    std::vector<Eigen::Vector4d> dq;
    std::vector<Twist> V;
  };
  void accelerations(World&, const std::vector<Pose>&, const std::vector<Twist>&, std::vector<Vec6>& a, CompliantContacts*,
                     double weight, FirstStage);
  void take_over(const World&, const Motion&, Stages);
  void advance_by_four(World&, const Motion&, double h, std::vector<Pose>& X, std::vector<Twist>& V, CompliantContacts*,
                       FirstStage);
  void advance_by_two(World&, const Motion&, double h, std::vector<Pose>& X, std::vector<Twist>& V, FirstStage);
  void measure_swing(const World&);

  Stage stages_[4];
  std::vector<Pose> X_;
  std::vector<Vec6> force_;
  std::vector<Vec3> applied_, joint_force_;  // [N] per body: of the first stage, without joints; through its parent joint
  struct Swinging {
    int body = 0;          // of the joint's two the one that swings faster
    double per_force = 0;  // [1/(kg m)]
  };
  std::vector<Swinging> swinging_;  // per joint
  double fastest_swing_ = 0;
  int swinging_body_ = -1;
  long copied_ = 0;  // StillBodies::changes when all bodies were taken over
};

/// Takes the drift out of joints after a step: Newton on C(q) = 0 in the mass metric, then J V = 0 (eq. (63) with F = 0).
/// Returns largest joint gap [m] left. `factored`: World::smooth has factors of a place near by, such as those of the last stage.
/// Where it has any to take out it leaves those of the end.
double project_joints(World&, std::vector<Pose>& X, std::vector<Twist>& V, std::vector<Vec6>& force, std::vector<Vec6>& result,
                      bool factored);

/// Turns a pose by a small rotation vector (world) and normalises.
void displace(Pose&, const Vec3& dp, const Vec3& rotation);

}  // namespace engine
