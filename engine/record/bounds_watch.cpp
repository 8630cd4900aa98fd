#include "engine/record/bounds_watch.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <sstream>
#include <utility>

namespace engine {
namespace {

// What a run says by itself: less than this is asked of every hard case.
constexpr double kDegree = std::numbers::pi / 180;  // [rad]
constexpr double kToldInside = 2e-3;                // [m] rigid contacts and ends of slides
constexpr double kToldUnsettled = 1e-3;             // [m/s] a hundred times the solver's tolerance
constexpr double kToldBeyond = 0.5 * kDegree;       // [rad]
constexpr double kToldCrossed = 0.05;               // [m] two vehicles: half the way between the points by which they are felt

}  // namespace

/// A part pressed in by all its thickness has slipped through: its law no longer knows from which side it came.
void BoundsWatch::watch_compression(const Constraint& c, double time, double duration) {
  const double depth = -c.gap;
  if (duration <= 0) return;
  // whatever it carries: what is pressed deeper than it is thick is told
  if (depth > c.spring.thickness) too_deep_.note(depth, time, c);
  if (c.impulse[0] < 0.5 * c.spring.stiffness * depth * duration) return;  // slack: it springs back
  compression_ = std::max(compression_, depth);
}

/// What rigid contacts and joints promise to keep. What overlaps at the start is told by itself, and takes its time to part.
void BoundsWatch::watch(const World& world, const Constraint& c, double time, double duration) {
  if (is_compliant(c)) {
    if (is_contact(c) && (c.impulse[0] > 0 || c.gap <= 0)) watch_compression(c, time, duration);
    return;
  }
  if (c.kind == ConstraintKind::limit) (c.slides ? overslid_ : overturned_).note(-c.gap, time, c);
  if (is_contact(c) && -c.gap > world.log.overlap_at_start(c.a.record, c.b.record) + kToldInside)
    (c.shapes.between_vehicles() ? crossed_ : stood_inside_).note(-c.gap, time, c);
}

void BoundsWatch::close(const World& world, Diagnostics& diagnostics) const {
  diagnostics.max_compression = compression_;
  std::vector<std::string>& warnings = diagnostics.warnings;
  auto name = [&](int body) { return body >= 0 ? world.model.bodies[body].name : std::string("the ground"); };
  auto at = [](const Shortfall& s) { return " at " + std::to_string(std::lround(1e3 * s.time)) + " ms"; };
  auto told = [](double value) {
    std::ostringstream text;
    text << std::setprecision(value < 99.5 ? 2 : 4) << value;
    return text.str();
  };
  constexpr const char* kCompare = "; see whether runs of other steps say the same of what follows";
  if (too_deep_.amount > 0)
    warnings.push_back(
        name(too_deep_.body_a) + " was pressed " + told(1e3 * too_deep_.amount) + " mm into " + name(too_deep_.body_b) +
        at(too_deep_) +
        ", more than its thickness: do not rely on what it does from there on; more stiffness or a shorter step may hold it out");
  if (world.log.unsettled.amount > kToldUnsettled)
    warnings.push_back("the forces between " + name(world.log.unsettled.body_a) + " and " + name(world.log.unsettled.body_b) +
                       at(world.log.unsettled) + " were solved to " + told(world.log.unsettled.amount) +
                       " m/s only, something is jammed" + kCompare);
  for (const auto& [inside, most] : {std::pair(stood_inside_, kToldInside), std::pair(crossed_, kToldCrossed)})
    if (inside.amount > most)
      warnings.push_back(name(inside.body_a) + " stood " + told(1e3 * inside.amount) + " mm inside " + name(inside.body_b) +
                         at(inside) + kCompare);
  if (overturned_.amount > kToldBeyond)
    warnings.push_back(name(overturned_.body_a) + " was turned " + told(overturned_.amount / kDegree) +
                       " deg beyond its range against " + name(overturned_.body_b) + at(overturned_) + kCompare);
  if (overslid_.amount > kToldInside)
    warnings.push_back(name(overslid_.body_a) + " slid " + told(1e3 * overslid_.amount) + " mm beyond its range against " +
                       name(overslid_.body_b) + at(overslid_) + kCompare);
}

}  // namespace engine
