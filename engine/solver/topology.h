// Which bodies hang together: the joints as a forest, in the order the factorisation wants.
#pragma once

#include <vector>

#include "engine/model/model.h"

namespace engine {

/// Bodies in tree order. Joints that close a loop or can break are left to the contact solver, which knows what they carry.
struct Topology {
  struct Link {
    int body = 0;
    int parent = -1;                  // body; -1: the world or none
    int joint = -1;                   // -1: a free root
    bool body_is_joint_child = true;  // else the joint was written the other way round
    int tree = 0;
  };
  struct Tree {
    int begin = 0, end = 0;  // into links: leaves first, root last
    int person = -1;
  };
  std::vector<Link> links;
  std::vector<Tree> trees;
  std::vector<int> tree_of_body;  // -1: a fixed body
  std::vector<int> link_of_body;  // -1: a fixed body
  std::vector<int> loops;         // joint indices
};

/// `broken` (per joint, may be empty) names joints that no longer hold.
Topology build_topology(const Model&, const std::vector<char>& broken);

}  // namespace engine
