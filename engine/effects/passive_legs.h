// Passive torques of legs on the bodies of a run: which joints make a leg, how far each is flexed, and along which axis it acts.
#pragma once

#include <cmath>
#include <vector>

#include "engine/laws/passive_torque.h"
#include "engine/model/model.h"

namespace engine {

/// Joints of one leg whose passive torques know each other's angles; -1: has none.
struct PassiveLeg {
  int hip = -1;
  int knees[2] = {-1, -1};
  int ankle = -1;
};

/// The legs of a model, from hip, knees and ankle that follow each other.
std::vector<PassiveLeg> passive_legs(const Model&);

/// Flexion [rad] of a joint with passive torque, and how it answers a relative angular velocity: rate = gradient . (w_C - w_P),
/// world. The child's attitude in the parent is R_y(flexion) R_x(side) R_z(turn); singular at a side of 90 deg, out of every such
/// range.
struct Flexion {
  double angle = 0;
  Vec3 gradient_W = Vec3::Zero();
};
Flexion flexion_of(const Joint&, const Pose& X_WP, const Pose& X_WC);

/// Calls act(joint, gradient_W, torque [N m] towards flexion, stiffness [N m/rad]) for each joint of the leg. By virtual work the
/// knee's torque acts in each joint that has a part of its flexion.
template <class Act>
void for_passive_joints(const Model& model, const PassiveLeg& leg, const std::vector<Pose>& X_WB, Act&& act) {
  const int joints[4] = {leg.hip, leg.knees[0], leg.knees[1], leg.ankle};
  constexpr int kAngle[4] = {0, 1, 1, 2};
  Flexion of[4];
  Vec3 flexion = Vec3::Zero();
  for (int i = 0; i < 4; ++i) {
    if (joints[i] < 0) continue;
    const Joint& joint = model.joints[joints[i]];
    of[i] = flexion_of(joint, joint.parent < 0 ? Pose{} : X_WB[joint.parent], X_WB[joint.child]);
    flexion[kAngle[i]] += of[i].angle;
  }
  const PassiveTorques passive = passive_torques(flexion);
  for (int i = 0; i < 4; ++i) {
    if (joints[i] < 0) continue;
    const double share = model.joints[joints[i]].passive_share;
    act(joints[i], of[i].gradient_W, share * passive.torque[kAngle[i]], share * passive.stiffness[kAngle[i]]);
  }
}

}  // namespace engine
