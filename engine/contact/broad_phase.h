// Broad phase: which bodies, and which trees of them, can touch within a time.
#pragma once

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
class BroadPhase {
 public:
  /// From where bodies are and how they move. Before anything looks for contacts.
  void look(const Outlook&);
  bool close(int tree_a, int tree_b) const {
    return tree_a < 0 || tree_b < 0 || tree_a == tree_b || close_[static_cast<std::size_t>(tree_a) * radius_.size() + tree_b] != 0;
  }
  /// Farther apart than their reach and `pair_margin`?
  bool apart(const Motion& at, int body_a, int body_b) const {
    const double within = swept_[body_a] + swept_[body_b] + spare_;
    return (at.X_WB[body_a].p - at.X_WB[body_b].p).squaredNorm() > within * within;
  }

 private:
  double spare_ = 0;           // [m] of a pair
  std::vector<double> swept_;  // [m] per body: about its centre, with its way
  std::vector<Vec3> centre_;   // [m] per tree
  std::vector<double> radius_;
  std::vector<char> close_;  // trees x trees
};

}  // namespace engine
