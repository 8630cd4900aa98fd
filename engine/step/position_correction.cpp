#include "engine/step/position_correction.h"

#include <algorithm>
#include <limits>

#include "engine/step/bounds.h"

namespace engine {
namespace {

constexpr double kLimitSlop = 2e-5;        // [rad]
constexpr double kRecovery = 0.5;          // [-] share of a penetration that a step left taken out in the next
constexpr double kRecoverySpeed = 0.2;     // [m/s] at which a deeper one, there from the start, is taken out
constexpr double kLimitRecoverySpeed = 2;  // [rad/s]

double slop_of(const Constraint& c) {
  return is_angular_limit(c) ? kLimitSlop : kSlop;
}

/// What the position of a rigid contact or stop still needs beyond its impulse.
double wanted(const Constraint& c, double h, double weight) {
  const double slop = slop_of(c);
  const double travel = h * (0.5 * (c.u.before[0] + c.u.smooth[0]) + weight * (c.u.after[0] - c.u.smooth[0]));
  const double end = c.gap + travel;
  double floor = -slop;
  if (c.gap < -slop) floor = std::min(c.gap + recovery(c, h), -slop);
  return std::min(floor, 0.0) - end;
}

}  // namespace

double recovery(const Constraint& c, double h) {
  const bool limit = is_angular_limit(c);
  const double beyond = -c.gap - slop_of(c);
  if (beyond <= 0) return 0;
  const double fresh = limit ? kMayExceed : kMayPenetrate;  // what a step leaves; deeper was there before: apart gently
  return std::min(c.gap > -fresh ? kRecovery * beyond : h * (limit ? kLimitRecoverySpeed : kRecoverySpeed), beyond);
}

void correct_positions(StepContext& s, const std::vector<int>& island) {
  bool any = false;
  s.buffers.allowed.clear();
  for (const int i : island) {
    Constraint& c = s.constraints[i];
    c.push = 0;  // an earlier pass pushed against joints that held then
    const bool rigid = (c.kind == ConstraintKind::contact || c.kind == ConstraintKind::limit) && !is_compliant(c);
    s.buffers.allowed.push_back(rigid ? wanted(c, s.length, s.buffers.weight[i]) : -std::numeric_limits<double>::infinity());
    any = any || s.buffers.allowed.back() > 1e-9;
  }
  if (any) s.world.solver.push_apart(s.constraints, island, s.buffers.allowed);
}

}  // namespace engine
