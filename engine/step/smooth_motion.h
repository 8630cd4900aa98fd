// Motion under smooth forces and joints: classic fourth-order Runge-Kutta with full re-evaluation in each stage.
//
// The quaternion is integrated as a vector of four, dq/dt = 1/2 (0, w) q, and normalised once at the end: that keeps order four
// (an exponential map per stage with a summed w does not). Joint multipliers are solved anew in each stage with g = -Jdot V.
//
// What is touched follows its impulses to order one. There velocity Verlet, with what depends on velocity at that foretold for the
// end, takes half of the time and gives order two. A swing under joint forces neither gains nor loses by it.
#pragma once

#include <span>
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

  /// What moves by a schedule stands so during the steps that follow.
  void take_over(const World&, const Motion&);

  /// Advances these trees by h under the plan's forces; `looped`: all that closed loops hold are among them. `compliant` (may be
  /// null) adds the forces of contacts in every stage, of which there must be four. Returns their fastest swing.
  Swing advance(World&, std::span<const int> trees, bool looped, Motion&, double h, Stages, CompliantContacts* compliant = nullptr,
                FirstStage first = FirstStage::within_step);

 private:
  struct Stage {
    std::vector<Vec6> a;  // dv, dw
    std::vector<Eigen::Vector4d> dq;
    std::vector<Twist> V;
  };
  /// The trees in hand.
  struct Trees {
    std::span<const int> list;
    bool looped;
  };
  void accelerations(World&, const Trees&, Stage&, CompliantContacts*, double weight, FirstStage);
  void advance_by_four(World&, const Trees&, Motion&, double h, CompliantContacts*, FirstStage);
  void advance_by_two(World&, const Trees&, Motion&, double h, FirstStage);
  Swing swing(const World&, const Trees&);

  Stage stages_[4];
  std::vector<Pose> X_;
  std::vector<Vec6> force_;
  std::vector<Vec3> applied_, joint_force_;  // [N] per body: of the first stage, without joints; through its parent joint
  struct Swinging {
    int body = 0;          // of the joint's two the one that swings faster
    double per_force = 0;  // [1/(kg m)]
  };
  std::vector<Swinging> swinging_;  // per joint
  long copied_ = 0;                 // StillBodies::changes when all bodies were taken over
};

/// Takes the drift out of joints after a step: Newton on C(q) = 0 in the mass metric, then J V = 0 (eq. (63) with F = 0).
/// Returns largest joint gap [m] left. `factored`: World::smooth has factors of a place near by, such as those of the last stage.
/// Where it has any to take out it leaves those of the end.
double project_joints(World&, std::vector<Pose>& X, std::vector<Twist>& V, std::vector<Vec6>& force, std::vector<Vec6>& result,
                      bool factored);

/// Turns a pose by a small rotation vector (world) and normalises.
void displace(Pose&, const Vec3& dp, const Vec3& rotation);

}  // namespace engine
