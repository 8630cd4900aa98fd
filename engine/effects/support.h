// What somebody who waits in the zero condition stands, sits or lies on at the start, where that can move away.
#pragma once

#include <vector>

#include "engine/state.h"

namespace engine {

constexpr double kBears = 0.5;  // [-] upright part of a normal: what is steeper bears nobody

struct StoodOn {
  int person = 0;
  int part = 0;               // of the person
  int on = 0;                 // body
  Vec3 place = Vec3::Zero();  // [m] of it under the part, in its axes
};

/// Of each person that waits and that neither ground nor a fixed body bears: bodies that move, up to 5 cm under its parts. Poses
/// and places in a scene are good to a few centimetres, and a gap is no less a stand for that.
std::vector<StoodOn> supports_at_start(const Model&);

/// Does a support move at a place [m, world], and not along with who is on it?
bool moves_from_under(const Model&, const Motion&, int person, int on, const Vec3& place);

}  // namespace engine
