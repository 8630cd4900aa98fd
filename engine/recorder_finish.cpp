// What only the whole run tells: who came to rest, where it fell short of its bounds.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <sstream>
#include <string>

#include "engine/recorder.h"

namespace engine {
namespace {

// What a run says by itself: less than this is asked of every hard case.
constexpr double kDegree = std::numbers::pi / 180;  // [rad]
constexpr double kToldUnsettled = 1e-3;             // [m/s] a hundred times the solver's tolerance
constexpr double kToldBeyond = 0.5 * kDegree;       // [rad]
constexpr double kToldCrossed = 0.05;               // [m] two vehicles: half the way between the points by which they are felt

/// An [[impact]] settles the exchange of one pair: one that never came about is a question the run did not answer.
void warn_of_idle_impacts(const World& world, std::vector<std::string>& warnings) {
  const Model& model = world.model;
  for (const ImpactSettings& s : model.impacts) {
    const bool acted = std::any_of(world.log.exchanges.begin(), world.log.exchanges.end(), [&](const ContactRecord& c) {
      return std::minmax(c.body_a, c.body_b) == std::minmax(s.body_a, s.body_b);
    });
    if (acted) continue;
    const Body &A = model.bodies[s.body_a], &B = model.bodies[s.body_b];
    const bool asked = model_between(A.collision_model, B.collision_model) == CollisionModel::kudlich_slibar;
    warnings.push_back("[[impact]] of " + A.name + " with " + B.name + " never acted: " +
                       (asked ? "they exchanged no impulse" : "they do not both have collision = \"kudlich_slibar\""));
  }
}

/// Whether a tree stands from `time` on. What rocks on its edges is slow there, and goes on: it has no halt.
bool halts(const World& world, const Recording& recording, std::size_t tree, double time) {
  constexpr double kStands = 5e-3;  // [m/s] and [rad/s]
  const auto& all = recording.snapshots;
  if (time > all.back().time) return false;
  for (auto s = all.rbegin(); s != all.rend() && s->time > time; ++s)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int b = world.topology.links[l].body;
      const BodyState& body = s->bodies[static_cast<std::size_t>(b)];
      const Twist V = travel_of(world.model, b, body.X_WB, body.V_WB);
      if (V.v.norm() > kStands || V.w.norm() > kStands) return false;
    }
  return true;
}

}  // namespace

void Recorder::warn_of_shortfalls(const World& world, std::vector<std::string>& warnings) const {
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

void Recorder::finish(const World& world, const State& state, Recording& recording) {
  for (std::size_t t = 0; t < world.topology.trees.size(); ++t) {
    if (rest_since_[t] < 0 || state.time - rest_since_[t] < 0.9 * kStillTime) continue;
    const int root = world.topology.links[world.topology.trees[t].end - 1].body;
    const int person = world.model.bodies[root].person;
    if (person >= 0 && !state.released[person]) continue;
    const double time = halts(world, recording, t, halted_[t]) ? halted_[t] : rest_since_[t];
    events_.push_back({time, "rest", root, -1, recording.at(time).bodies[root].X_WB.p, 0});
  }
  recording.events = world.log.events;
  recording.events.insert(recording.events.end(), events_.begin(), events_.end());
  std::stable_sort(recording.events.begin(), recording.events.end(),
                   [](const Event& a, const Event& b) { return a.time < b.time; });
  for (HeadMotion& head : recording.heads) {
    if (world.model.persons[head.person].head < 0) continue;
    head.time = times_;
    head.acceleration.resize(times_.size());
  }
  recording.diagnostics = world.log.diagnostics;
  energy_.close(world, recording.diagnostics);
  recording.diagnostics.max_compression = compression_;
  warn_of_shortfalls(world, recording.diagnostics.warnings);
  warn_of_idle_impacts(world, recording.diagnostics.warnings);
  // the depth of a compliant contact is a deformation, not an error
  for (const ContactRecord& c : recording.snapshots.back().contacts)
    if (!yields_between(world.model, c.body_a, c.body_b))
      recording.diagnostics.rest_penetration = std::max(recording.diagnostics.rest_penetration, c.depth);
}

}  // namespace engine
