// How bodies answer impulses on each other through their joints: blocks of the inverse of the factorised system.
#pragma once

#include <vector>

#include "engine/solver/articulation.h"

namespace engine {

class Response {
 public:
  void reset(const Topology&);

  /// Marks a body whose blocks will be asked for. Call for all, then compute().
  void touch(const Topology&, int body);
  void compute(const Topology&, const Articulation&);
  void clear();

  /// Velocity (6) of body i for a unit impulse (6) on body j: 6x6. Both touched, same tree.
  const Mat6& between(const Topology&, int i, int j) const;
  const std::vector<int>& touched() const { return touched_; }

 private:
  std::vector<int> slot_of_body_;         // place of a body in its tree's list, -1: not marked
  std::vector<std::vector<int>> marked_;  // per tree: bodies marked with all their ancestors
  std::vector<int> trees_;                // trees with marks
  std::vector<std::size_t> base_;         // per tree, into blocks_
  std::vector<Mat6> blocks_;
  std::vector<int> touched_;
};

}  // namespace engine
