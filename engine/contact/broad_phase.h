// Broad phase: which bodies, and which trees of them, can touch within a time.
#pragma once

#include <algorithm>
#include <vector>

#include "engine/state.h"

namespace engine {

struct World;

/// What could touch: bodies as they are `at` an instant, and how far ahead one looks. `at` is the state itself, the end of a step
/// under way, or a stage of Runge and Kutta; the state has the contact memory.
struct Outlook {
  World& world;
  State& state;
  const Motion& at;
  double within;  // [s]
};

/// Largest distance [m] body `b` can travel towards anything in this time, with a little to spare.
double contact_margin(const Outlook&, int body);

/// The same between two bodies, from their relative motion.
double pair_margin(const Outlook&, int a, int b);

/// Spheres about bodies and trees, with the way they can go. Bounds on `pair_margin`, cheaper than it.
///
/// Of two trees that are both still (StillBodies) nothing is asked but at the start. A tree that moves remembers how far it may go
/// before it can reach any that is still: until then those cost nothing, however many they are.
class BroadPhase {
 public:
  /// From where bodies are and how they move. Before anything looks for contacts. Is anything else close than at the last look?
  bool look(const Outlook&);
  bool close(int tree_a, int tree_b) const {
    if (tree_a < 0 || tree_b < 0 || tree_a == tree_b) return stirs(tree_a) || stirs(tree_b);
    return close_[static_cast<std::size_t>(tree_a) * trees_.size() + tree_b] != 0;
  }
  /// Farther apart than their reach and `pair_margin`?
  bool apart(const Motion& at, int body_a, int body_b) const {
    const double within = swept_[body_a] + swept_[body_b] + spare_;
    return (at.X_WB[body_a].p - at.X_WB[body_b].p).squaredNorm() > within * within;
  }

 private:
  struct Sphere {
    Vec3 centre = Vec3::Zero();  // [m] of its first body
    double radius = 0;           // [m]
    bool moves = true;
    // of one that moves: at the look that measured how far it was from all that are still
    Vec3 measured_at = Vec3::Zero();
    double measured_radius = 0, slack = 0;  // [m]
  };
  bool stirs(int tree) const { return at_start_ || (tree >= 0 && trees_[tree].moves); }
  void sweep(const Outlook&, int body);
  void enclose(const Outlook&, int tree);
  void begin(const Outlook&);
  bool note(std::size_t a, std::size_t b, bool close);
  bool look_at_still(std::size_t tree);
  double apart(std::size_t a, std::size_t b) const;

  double spare_ = 0;            // [m] of a pair
  std::vector<double> swept_;   // [m] per body: about its centre, with its way
  std::vector<double> wheels_;  // [m] per body: how far its wheels reach
  std::vector<Sphere> trees_;
  std::vector<std::size_t> moving_, still_;  // trees
  std::vector<char> close_;                  // trees x trees
  long begun_ = -1;                          // StillBodies::changes at the last look at everything
  bool at_start_ = false;                    // overlaps are told of those that wait, too
};

}  // namespace engine
