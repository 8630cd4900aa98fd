#include "engine/effects/passive_legs.h"

#include "engine/math/functions.h"

namespace engine {

std::vector<PassiveLeg> passive_legs(const Model& model) {
  std::vector<PassiveLeg> legs;
  std::vector<int> foot;  // per leg: the body it has come down to
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const Joint& joint = model.joints[j];
    if (joint.passive == PassiveTorque::none) continue;
    std::size_t at = 0;
    while (at < legs.size() && (foot[at] != joint.parent || joint.passive == PassiveTorque::hip)) ++at;
    if (at == legs.size()) {
      legs.emplace_back();
      foot.push_back(-1);
    }
    PassiveLeg& leg = legs[at];
    foot[at] = joint.child;
    if (joint.passive == PassiveTorque::hip) leg.hip = j;
    if (joint.passive == PassiveTorque::knee) leg.knees[leg.knees[0] < 0 ? 0 : 1] = j;
    if (joint.passive == PassiveTorque::ankle) leg.ankle = j;
  }
  return legs;
}

Flexion flexion_of(const Joint& joint, const Pose& X_WP, const Pose& X_WC) {
  constexpr double kSteepest = 0.1;  // [-] cosine of the side angle: beyond 84 deg the axis turns no further
  const Mat3 R_WP = X_WP.q.toRotationMatrix();
  const Mat3 R = R_WP.transpose() * X_WC.q.toRotationMatrix();
  const double cosine = math::hypot(R(0, 2), R(2, 2));
  Flexion out;
  out.angle = joint.flexes_about * math::atan2(R(0, 2), R(2, 2));
  const double sine_y = cosine > 0 ? R(0, 2) / cosine : 0, cosine_y = cosine > 0 ? R(2, 2) / cosine : 1;
  // axes of the three turns in the parent: y, R_y x, R_y R_x z; the first of their reciprocal basis
  const double tangent = -R(1, 2) / std::max(cosine, kSteepest);
  const Vec3 gradient_P(tangent * sine_y, 1, tangent * cosine_y);
  out.gradient_W = joint.flexes_about * (R_WP * gradient_P);
  return out;
}

}  // namespace engine
