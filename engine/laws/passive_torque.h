// Passive elastic torque of hip, knee and ankle inside their ranges of motion: ligaments, capsules, muscles at rest.
//
// R. Riener, T. Edrich: Identification of passive elastic joint moments in the lower extremities, J. Biomechanics 32 (1999),
// angles in degrees, moments in N m:
//   M_hip   = exp(1.4655 - .0034 knee - .0750 hip) - exp(1.3403 - .0226 knee + .0305 hip) + 8.072
//   M_knee  = exp(1.800 - .0460 ankle - .0352 knee + .0217 hip) - exp(-3.971 - .0004 ankle + .0495 knee - .0128 hip) - 4.820
//             + exp(2.220 - .150 knee)
//   M_ankle = exp(2.1016 - .0843 ankle - .0176 knee) - exp(-7.9763 + .1949 ankle + .0008 knee) - 1.792
// In the paper the ankle's angle and moment count towards plantarflexion: the calf's muscle, which the terms of ankle and knee
// share, pulls the more the higher the toes and the straighter the knee. Here all three count towards flexion, the ankle's toes up.
//
// Measured on ten adults at rest; muscles that act are not in it. Each moment was fitted by itself, so no potential belongs to the
// three: the energy ledger books their work.
#pragma once

#include "engine/math/types.h"

namespace engine {

struct PassiveTorques {
  Vec3 torque = Vec3::Zero();     // [N m] towards flexion of hip, knee, ankle
  Vec3 stiffness = Vec3::Zero();  // [N m/rad] minus the slope of each over its own angle
};

/// No stiffness of the three exceeds it [N m/rad].
constexpr double kStiffestPassiveTorque = 900;

/// `flexion` [rad] of hip, knee and ankle (toes up). Beyond the angles that were measured the torque stays as at their end.
PassiveTorques passive_torques(const Vec3& flexion);

}  // namespace engine
