#include "engine/step/slip_end.h"

#include "engine/step/impact.h"

namespace engine {
namespace {

constexpr double kSlips = 1e-5;  // [m/s]

/// Impulse [N s] along `direction` (of the rows) of all points of the pair, and the most that friction could give.
struct Spent {
  double along = 0, most = 0;
};

Spent spent_by(const std::vector<Constraint>& list, const Constraint& of, const Vec3& direction) {
  Spent out;
  for (const Constraint& c : list) {
    if (!is_contact(c) || c.a.record != of.a.record || c.b.record != of.b.record) continue;
    out.along += (c.frame * c.impulse).dot(direction);
    out.most += c.surface.friction * c.impulse[0];
  }
  return out;
}

/// [s] until the slip of a contact is spent: from the speed that friction would leave it with were it spent all along against it.
/// What another direction of friction does to the slip is in proportion to the impulses of the pair.
std::optional<double> time_of_end(const StepContext& s, const Constraint& c) {
  const Vec3 slip(0, c.u.before[1], c.u.before[2]);
  const double speed = slip.norm();
  if (!(speed > kSlips) || c.impulse[0] <= 0) return std::nullopt;
  const Vec3 along = slip / speed;
  const Spent spent = spent_by(s.constraints, c, c.frame * along);
  const double unbraked = c.u.free.dot(along), taken = c.u.after.dot(along) - unbraked;
  if (!(spent.along * taken > 0)) return std::nullopt;
  const double left = unbraked - taken / spent.along * spent.most;
  if (!(left < speed)) return std::nullopt;
  return s.length * speed / (speed - left);
}

}  // namespace

std::optional<SlipEnd> slip_end(const StepContext& s, std::optional<std::uint64_t> key) {
  std::optional<SlipEnd> first;
  for (const Constraint& c : s.constraints) {
    if (key ? c.key != *key : !is_contact(c) || is_compliant(c) || !is_between_free(s.world, c)) continue;
    if (!key && c.u.after[1] * c.u.before[1] + c.u.after[2] * c.u.before[2] > kSlips * kSlips) continue;
    if (const auto time = time_of_end(s, c); time && (key || *time < s.length) && (!first || *time < first->time))
      first = SlipEnd{c.key, *time};
  }
  return first;
}

}  // namespace engine
