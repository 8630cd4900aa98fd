// What changes while a model runs. A copyable value.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/math/types.h"

namespace engine {

/// Impulse of a contact or limit in the last step, found again by its key: the next solve starts from it.
struct WarmStart {
  std::uint64_t key = 0;
  Vec3 impulse_W = Vec3::Zero();  // [N s] world axes for contacts; first component for one-row blocks
};

struct State {
  double time = 0;                 // [s]
  std::vector<Pose> X_WB;          // per body
  std::vector<Twist> V_WB;         // per body
  std::vector<char> released;      // per person: 0 while in the zero condition
  std::vector<char> broken;        // per joint: 1 once its breaking force was passed
  std::vector<double> wheel_spin;  // [rad] per wheel, in the order of the vehicles' wheels
  std::vector<WarmStart> warm;     // sorted by key
};

}  // namespace engine
