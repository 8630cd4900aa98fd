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

/// A panel that is dented leaves the part its own share of the depth, and so does another part. What is neither, a box or a wall,
/// keeps its shape.
void BoundsWatch::note_press(const Model& model, const Constraint& c, int part, int by) {
  if (!is_part(model, part)) return;
  const bool is_a = part == c.a.record, dented = by >= 0 && (model.bodies[by].vehicle >= 0 || is_part(model, by));
  const double share = !dented ? 1 : is_a ? c.spring.share_a : 1 - c.spring.share_a;
  presses_.push_back({part, by, (is_a ? 1 : -1) * c.frame.col(0), -c.gap, -share * c.gap, c.spring.thickness, c.shapes.one_person});
}

/// Half of its thickness is what one side may press in (scenes/README.md), and what two may together. Whatever the dents hold of
/// it, surfaces that overlap by all of the thickness have met through the part.
double BoundsWatch::Squeeze::excess() const {
  const double thickness = std::min(one.thickness, other.thickness);
  // who curls up presses an arm to the neck, and nothing is lost by it until all of the arm is pressed in
  if (one.by_itself || other.by_itself) return (one.own + other.own) / thickness;
  return std::max((one.own + other.own) / (0.5 * thickness), (one.depth + other.depth) / thickness);
}

/// Each contact by itself knows one side, and gives it the same room as if there were no other.
void BoundsWatch::watch_squeezes(const World& world, const std::vector<Constraint>& conditions, double time) {
  constexpr double kOpposite = -0.5;  // [-] normals less than 60 degrees from straight against each other
  presses_.clear();
  for (const Constraint& c : conditions) {
    if (!is_contact(c) || !is_compliant(c) || c.impulse[0] <= 0 || c.gap >= 0) continue;
    note_press(world.model, c, c.a.record, c.b.record);
    note_press(world.model, c, c.b.record, c.a.record);
  }
  for (std::size_t i = 0; i < presses_.size(); ++i)
    for (std::size_t k = i + 1; k < presses_.size(); ++k) {
      const Squeeze now{time, presses_[i], presses_[k]};
      if (now.one.part != now.other.part || now.one.normal.dot(now.other.normal) > kOpposite) continue;
      if (now.excess() > 1 && (squeezed_.one.part < 0 || now.excess() > squeezed_.excess())) squeezed_ = now;
    }
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
  if (squeezed_.one.part >= 0)
    warnings.push_back(name(squeezed_.one.part) + " was pressed " + told(1e3 * squeezed_.one.depth) + " mm by " +
                       name(squeezed_.one.by) + " and " + told(1e3 * squeezed_.other.depth) + " mm by " + name(squeezed_.other.by) +
                       " from the other side at " + std::to_string(std::lround(1e3 * squeezed_.time)) +
                       " ms, together more than it has room for: the contact law holds for less, do not rely on forces and "
                       "motion from there on");
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
