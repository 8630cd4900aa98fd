#include "engine/laws/passive_torque.h"

#include <algorithm>
#include <numbers>

#include "engine/math/functions.h"

namespace engine {

PassiveTorques passive_torques(const Vec3& flexion) {
  constexpr double kDegree = std::numbers::pi / 180;
  const Vec3 lower(-30, -5, -55), upper(125, 145, 25);  // [deg] what was measured, a little more
  const Vec3 at = (flexion / kDegree).cwiseMax(lower).cwiseMin(upper);
  const Vec3 within = (flexion / kDegree - at).cwiseEqual(Vec3::Zero()).cast<double>();
  const double hip = at[0], knee = at[1], ankle = -at[2];

  const double extended = math::exp(1.4655 - .0034 * knee - .0750 * hip);
  const double flexed = math::exp(1.3403 - .0226 * knee + .0305 * hip);
  const double calf = math::exp(1.800 - .0460 * ankle - .0352 * knee + .0217 * hip);
  const double bent = math::exp(-3.971 - .0004 * ankle + .0495 * knee - .0128 * hip);
  const double straight = math::exp(2.220 - .150 * knee);
  const double toes_up = math::exp(2.1016 - .0843 * ankle - .0176 * knee);
  const double toes_down = math::exp(-7.9763 + .1949 * ankle + .0008 * knee);

  PassiveTorques out;
  out.torque = {extended - flexed + 8.072, calf - bent - 4.820 + straight, -(toes_up - toes_down - 1.792)};
  out.stiffness = {.0750 * extended + .0305 * flexed, .0352 * calf + .0495 * bent + .150 * straight,
                   .0843 * toes_up + .1949 * toes_down};
  out.stiffness = (out.stiffness / kDegree).cwiseProduct(within);
  return out;
}

}  // namespace engine
