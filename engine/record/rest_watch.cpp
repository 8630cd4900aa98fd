#include "engine/record/rest_watch.h"

#include <algorithm>
#include <cmath>

#include "engine/measure/parties.h"

namespace engine {
namespace {

constexpr double kStillSpeed = 0.05;  // [m/s]
constexpr double kStillTurn = 0.3;    // [rad/s]
constexpr double kStillTime = 0.25;   // [s] that long below both: at rest
constexpr double kBegins = 3e-3;      // [-] of these, a mean motion that is none of the solver's
constexpr double kHolds = 0.1;        // [-] one that creeps

/// How fast a body of that motion is, by what counts as still.
double pace_of(const Twist& V) {
  return std::max(V.v.norm() / kStillSpeed, V.w.norm() / kStillTurn);
}

/// [s] from when on nothing sets in motion by the clock what rests: no drive, no brake or friction that lets go, no softer surface.
double quiet_from(const Model& model) {
  constexpr double kPicksUp = 1;  // [s] until a twentieth of a metre per second squared is seen as motion
  double last = -kPicksUp;
  const auto take = [&last](double time) {
    if (std::isfinite(time)) last = std::max(last, time);
  };
  const auto changes = [&](const Schedule& schedule, bool rises) {
    const auto& knots = schedule.knots();
    for (std::size_t i = 1; i < knots.size(); ++i)
      if (knots[i].value < knots[i - 1].value || (rises && knots[i].value > knots[i - 1].value)) take(knots[i].time);
  };
  for (const Vehicle& vehicle : model.vehicles) {
    changes(vehicle.drive_force, true);
    changes(vehicle.brake, false);
    for (const DriverPhase& phase : vehicle.sequence) {
      if (phase.drives && phase.force != 0) take(phase.first_force + phase.build_up);
      if (!phase.drives) take(phase.until);
    }
  }
  const auto lets_go = [&](const SurfaceProperties& surface) {
    changes(surface.friction_body, false);
    changes(surface.friction_ground, false);
    changes(surface.stiffness, true);
  };
  for (const Body& body : model.bodies) lets_go(body.surface);
  lets_go(model.ground.surface);
  for (const auto& patch : model.ground.patches) changes(patch.friction, false);
  return last + kPicksUp;
}

/// Of the fastest body of a tree, whatever it does.
double motion_of(const World& world, const State& state, std::size_t tree) {
  double motion = 0;
  for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l)
    motion = std::max(motion, pace_of(state.V_WB[world.topology.links[l].body]));
  return motion;
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

/// Whether somebody who waits in the zero condition has a rest of its own: what is ridden as any vehicle, its rider where the two
/// came there. Who stands on its feet stands as it stood.
bool rests_waiting(const World& world, const State& state, const Recording& recording, int b) {
  constexpr double kWent = 1e-3;  // [m]
  const Body& body = world.model.bodies[b];
  if (body.vehicle >= 0) return true;
  const Vec3 way = state.X_WB[b].p - recording.snapshots.front().bodies[b].X_WB.p;
  return world.model.persons[body.person].mount >= 0 && way.norm() > kWent;
}

}  // namespace

Twist travel_of(const Model& model, int b, const Pose& X, const Twist& V) {
  constexpr double kUpright = 0.7;                // [-] cosine: leaning by 45 deg it is about to fall on its side
  constexpr double kRocks = 0.5, kBounces = 0.3;  // [rad/s], [m/s] more is no rocking on springs
  const int v = model.bodies[b].vehicle;
  if (v < 0 || model.vehicles[v].body != b || !has_track(model.vehicles[v])) return V;  // a two-wheeler topples from its wheels
  const Vec3 up = X.q * Vec3::UnitZ();
  const double yaw = up.dot(V.w);
  if (up.z() < kUpright || (V.w - yaw * up).norm() > kRocks || std::abs(up.dot(V.v)) > kBounces) return V;
  double height = 0;  // of the road, from the centre
  for (const Wheel& wheel : model.vehicles[v].wheels) height += wheel.hub_B.z() - wheel.radius;
  const Vec3 at_road = V.v + height / static_cast<double>(model.vehicles[v].wheels.size()) * V.w.cross(up);
  return {.v = at_road - up.dot(at_road) * up, .w = yaw * up};
}

RestWatch::RestWatch(const World& world)
    : of_trunk_(trunks_of(world.model)),
      has_trunk_(world.topology.trees.size(), 0),
      still_since_(world.topology.trees.size(), -1),
      rest_since_(world.topology.trees.size(), -1),
      halted_(world.topology.trees.size(), 0),
      motion_(world.topology.trees.size(), 0),
      step_motion_(world.topology.trees.size(), 0),
      quiet_from_(quiet_from(world.model)) {
  for (int t = 0; t < static_cast<int>(world.topology.trees.size()); ++t) {
    const auto& tree = world.topology.trees[t];
    if (tree.end - tree.begin == 1) alone_.push_back(t);
    for (int l = tree.begin; l < tree.end; ++l) has_trunk_[t] = has_trunk_[t] || of_trunk_[world.topology.links[l].body];
  }
}

/// Of the fastest body that tells when the tree rests, by its way. A person rests with its trunk: a foot may go on sinking.
double RestWatch::travel_of_tree(const World& world, const State& state, std::size_t tree) const {
  double motion = 0;
  for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
    const int b = world.topology.links[l].body;
    if (!tells_of(b, tree)) continue;
    motion = std::max(motion, pace_of(travel_of(world.model, b, state.X_WB[b], state.V_WB[b])));
  }
  return motion;
}

/// A body by itself slides to rest at once, and friction may change on its last steps: the step after which it would stop within
/// two more tells when, but not the one in which it stops. Limbs settle for long: of them the recorded interval tells.
void RestWatch::watch_step(const World& world, const State& state) {
  constexpr double kHum = 3e-4;  // [-] what the solver may leave of a speed that is none
  const double step = state.time - watched_;
  watched_ = state.time;
  for (const int tree : alone_) {
    const auto t = static_cast<std::size_t>(tree);
    const double motion = travel_of_tree(world, state, t), slowed = step_motion_[t] - motion;
    step_motion_[t] = motion;
    if (motion < 1 && motion > std::max(0.5 * slowed, kHum) && motion < 2 * slowed)
      halted_[t] = state.time + motion / slowed * step;
  }
}

void RestWatch::list_stirring(const World& world) {
  listed_ = world.still.changes;
  stirs_.assign(world.topology.trees.size(), 0);
  for (const int b : world.still.others)
    if (const int tree = world.topology.tree_of_body[b]; tree >= 0) stirs_[tree] = 1;
}

void RestWatch::watch_snapshot(const World& world, const State& state, double since) {
  if (listed_ != world.still.changes) list_stirring(world);
  for (std::size_t t = 0; t < world.topology.trees.size(); ++t) {
    if (!stirs_[t] && rest_since_[t] >= 0 && still_since_[t] >= 0 && motion_[t] == 0) continue;  // nothing new
    const double any = motion_of(world, state, t);
    if (!(any < 1))
      still_since_[t] = -1;
    else if (still_since_[t] < 0)
      still_since_[t] = state.time;
    const double motion = travel_of_tree(world, state, t);
    if (!(motion < 1)) {
      rest_since_[t] = -1;
    } else if (rest_since_[t] < 0) {
      rest_since_[t] = state.time;
      // it slows down as it has since the instant before: that is when it stops, and not at the first instant it is slow
      const double slowing = since > 0 && !has_trunk_[t] ? (motion_[t] - motion) / since : 0;
      const bool seen = since > 0 && halted_[t] > state.time - since;   // step by step
      const double wait = slowing > 0 ? motion / slowing : kStillTime;  // long where it rocks or creeps: not by this slowing
      if (!seen) halted_[t] = state.time + (wait < kStillTime ? wait : 0);
    }
    motion_[t] = motion;
  }
}

bool RestWatch::Halves::grows(double begins) const {
  return after > begins && after > 1.5 * before;
}

/// Means, as what rattles is gone from them.
RestWatch::Halves RestWatch::halves_of(const World& world, const State& state, const Recording& recording, std::size_t tree) const {
  const auto& all = recording.snapshots;
  const double middle = state.time - 0.5 * kStillTime, first = state.time - kStillTime;
  Halves out;
  for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
    const int b = world.topology.links[l].body;
    if (!tells_of(b, tree)) continue;
    Twist mean[2];
    int count[2] = {0, 0};
    for (auto s = all.rbegin(); s != all.rend() && (s->time >= first || count[0] == 0); ++s) {
      const BodyState& body = s->bodies[static_cast<std::size_t>(b)];
      const Twist V = travel_of(world.model, b, body.X_WB, body.V_WB);
      const int half = s->time > middle;
      mean[half].v += V.v, mean[half].w += V.w;
      ++count[half];
    }
    if (count[0] == 0 || count[1] == 0) return {};
    for (const int half : {0, 1}) mean[half].v /= count[half], mean[half].w /= count[half];
    out.before = std::max(out.before, pace_of(mean[0]));
    out.after = std::max(out.after, pace_of(mean[1]));
    out.change = std::max(out.change, pace_of({.v = mean[1].v - mean[0].v, .w = mean[1].w - mean[0].w}));
  }
  return out;
}

/// Whether what is slow is so for a moment only: at the start on a road that falls, in a wind, by a small drive, upright on an
/// edge, at the top of its way, or because it creeps.
bool RestWatch::goes_on(const World& world, const State& state, const Recording& recording, std::size_t tree) const {
  const Halves halves = halves_of(world, state, recording, tree);
  const int person = world.model.bodies[world.topology.links[world.topology.trees[tree].end - 1].body].person;
  if (person >= 0 && !state.released[person]) return halves.after > kBegins;  // goes its way until it is touched
  // who lies there settles for long
  return halves.grows(kBegins) || (!has_trunk_[tree] && std::max(halves.after, halves.change) > kHolds);
}

bool RestWatch::all_at_rest(const World& world, const State& state, const Recording& recording) const {
  const auto long_enough = [&](double since) { return since >= 0 && state.time - since >= kStillTime; };
  if (state.time < quiet_from_ || still_since_.empty() || !std::all_of(still_since_.begin(), still_since_.end(), long_enough) ||
      !std::all_of(rest_since_.begin(), rest_since_.end(), long_enough))
    return false;
  for (std::size_t t = 0; t < still_since_.size(); ++t)
    if (goes_on(world, state, recording, t)) return false;
  return true;
}

void RestWatch::tell(const World& world, const State& state, const Recording& recording, std::vector<Event>& events) const {
  for (std::size_t t = 0; t < world.topology.trees.size(); ++t) {
    const int root = world.topology.links[world.topology.trees[t].end - 1].body;
    const int person = world.model.bodies[root].person;
    const bool waits = person >= 0 && !state.released[person];
    if (waits && !rests_waiting(world, state, recording, root)) continue;
    const int mount = waits ? world.model.persons[person].mount : -1;
    const int ridden = mount >= 0 ? world.topology.tree_of_body[mount] : -1;
    const std::size_t as = ridden >= 0 ? static_cast<std::size_t>(ridden) : t;  // rider and mount are one until they are touched
    if (rest_since_[as] < 0 || state.time - rest_since_[as] < 0.9 * kStillTime) continue;
    const Halves halves = halves_of(world, state, recording, as);
    if (halves.grows(has_trunk_[as] ? kHolds : kBegins) || (!has_trunk_[as] && std::min(halves.before, halves.after) > kHolds))
      continue;
    const double time = halts(world, recording, t, halted_[as]) ? halted_[as] : rest_since_[as];
    events.push_back({time, "rest", root, -1, recording.at(time).bodies[root].X_WB.p, 0});
  }
}

}  // namespace engine
