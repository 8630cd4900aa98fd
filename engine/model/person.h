#pragma once

#include <string>
#include <vector>

#include "engine/math/types.h"

namespace engine {

/// A tree of segments joined by ragdoll joints. Bodies carry the data; this names what belongs together.
struct Person {
  std::string name;
  std::vector<int> bodies;  // indices into Model::bodies, root first
  int head = -1;            // body index, -1: has none
  int torso = -1;
  int hips = -1;          // the root
  int mount = -1;         // body index of what it rides: that waits in the zero condition with it
  double stature = 1.75;  // [m]
  /// Zero condition: keeps pose and walking velocity at no cost until the first contact with anything but its support.
  bool zero_condition = true;
};

}  // namespace engine
