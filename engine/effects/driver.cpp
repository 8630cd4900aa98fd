// What the driver asks of the wheels: pedals by the clock, the wheel angle by the clock or along a path.
#include "engine/effects/driver.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/effects/registration.h"
#include "engine/effects/words.h"
#include "engine/math/functions.h"

namespace engine {
namespace {

bool ever(const Schedule& schedule) {
  return std::any_of(schedule.knots().begin(), schedule.knots().end(), [](const Schedule::Knot& k) { return k.value != 0; });
}

/// What a driver does in the run, in words; empty: nothing.
std::string acts_of(const Vehicle& vehicle) {
  std::string out;
  auto add = [&out](const std::string& act) { out += (out.empty() ? "" : ", ") + act; };
  double brake = 0;
  for (const Schedule::Knot& k : vehicle.brake.knots()) brake = std::max(brake, k.value * vehicle.brake_force);
  bool drives = ever(vehicle.drive_force);
  for (const DriverPhase& phase : vehicle.sequence) {
    if (phase.drives) drives = true;
    if (!phase.drives) brake = std::max(brake, phase.force);
  }
  if (brake > 0) add("brakes with up to " + number(1e-3 * brake) + " kN");
  if (drives) add("drives");
  if (vehicle.path.points.size() > 1) {
    add("follows a path");
  } else if (ever(vehicle.steer)) {
    add("steers");
  }
  return out;
}

Finding look_for_driver(const Model& model) {
  std::string acts;
  for (const Vehicle& vehicle : model.vehicles)
    if (const std::string act = acts_of(vehicle); !act.empty()) acts += (acts.empty() ? "" : "; ") + vehicle.name + " " + act;
  if (model.vehicles.empty()) return {false, "no vehicle", ""};
  if (acts.empty()) return {false, "no vehicle is braked, driven or steered", ""};
  const bool ridden = std::any_of(model.persons.begin(), model.persons.end(), [](const Person& p) { return p.mount >= 0; });
  return {true, acts, ridden ? "lean of ridden two-wheelers: until something touches them rider and mount are one, upright" : ""};
}

/// The place of a path nearest to a point, seen from above: on which leg, as a share of its length.
struct OnPath {
  std::size_t leg = 0;
  double share = 0, distance = 1e300, way = 0;  // [-], [m], [m] along the path from its start
};

/// A stretch of the path, [m] along it from its start.
struct PathStretch {
  double from = 0, to = 1e300;
};

/// Of a stretch of the path. Behind the end of the path its last leg goes on as far as the stretch does.
OnPath nearest_on(const std::vector<Vec3>& path, const Vec3& at, const PathStretch& within) {
  OnPath out;
  double way = 0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Vec3 d = (path[i + 1] - path[i]).cwiseProduct(Vec3(1, 1, 0));
    const bool last = i + 2 == path.size();
    const Vec3 from = (at - path[i]).cwiseProduct(Vec3(1, 1, 0));
    const double length = d.norm();
    const double least = std::max(0.0, (within.from - way) / length), most = std::min(last ? 1e9 : 1.0, (within.to - way) / length);
    if (least <= most) {
      const double s = std::clamp(from.dot(d) / d.squaredNorm(), least, most);
      const double distance = (from - s * d).norm();
      if (distance < out.distance) out = {i, s, distance, way + s * length};
    }
    way += length;
  }
  return out;
}

/// How far along the path [m] who is set down there begins. A lap ends where it begins: of places about as near, along the
/// vehicle's heading, the earliest.
double start_on(const std::vector<Vec3>& path, const Pose& X) {
  constexpr double kAsNear = 5;  // [m] a car's length: set down with its front or its middle at the start
  const OnPath nearest = nearest_on(path, X.p, {});
  double way = 0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Vec3 d = (path[i + 1] - path[i]).cwiseProduct(Vec3(1, 1, 0));
    const OnPath leg = nearest_on(path, X.p, {way, way + d.norm()});
    if (leg.distance < nearest.distance + kAsNear && d.dot(X.q * Vec3::UnitX()) > 0) return leg.way;
    way += d.norm();
  }
  return nearest.way;
}

/// The place nearest to who has been as far along the path as `reached` [m]. It is no earlier one, beyond what a driver who brakes
/// falls back by, and none much further on than the driver looks: a path may cross itself or come back to where it was.
OnPath place_on(const FollowedPath& path, const Vec3& at, double ahead, double& reached) {
  constexpr double kBack = 2, kAhead = 10;  // [m]
  const OnPath out = nearest_on(path.points, at, {reached - kBack, reached + std::max(kAhead, 2 * ahead)});
  reached = std::max(reached, out.way);
  return out;
}

/// [m] along the path, at that speed.
double looks_ahead(const FollowedPath& path, double speed) {
  return std::max(2.0, path.preview * speed);
}

/// Who is on the path and leaves it again, untouched: too fast for its bends.
LeftOut off_the_path(const Model& model, const Recording& run) {
  constexpr double kOn = 0.5, kOff = 1;  // [m]
  LeftOut out;
  for (std::size_t v = 0; v < model.vehicles.size(); ++v) {
    const Vehicle& vehicle = model.vehicles[v];
    if (vehicle.path.points.size() < 2 || run.snapshots.empty()) continue;
    const auto body = static_cast<std::size_t>(vehicle.body);
    bool was_on = false;
    double off = 0, when = 0, reached = start_on(vehicle.path.points, run.snapshots.front().bodies[body].X_WB);
    for (const Snapshot& s : run.snapshots) {
      const bool touched = std::any_of(s.contacts.begin(), s.contacts.end(), [&](const ContactRecord& c) {
        return c.body_a == vehicle.body || c.body_b == vehicle.body;
      });
      if (touched) break;
      const BodyState& state = s.bodies[body];
      const double distance =
          place_on(vehicle.path, state.X_WB.p, looks_ahead(vehicle.path, state.V_WB.v.norm()), reached).distance;
      was_on = was_on || distance < kOn;
      if (was_on && distance > off) off = distance, when = s.time;
    }
    if (off < kOff) continue;
    out.matters = true;
    out.text += (out.text.empty() ? "" : "; ") + vehicle.name + " leaves its path by up to " + number(off) + " m, at " +
                number(when) + " s: drive slower, or look further ahead with `preview`";
  }
  return out;
}

/// Where a vehicle will be when it answers to the wheel, turning and moving as it does: steered from where it is, it weaves at
/// speed.
Pose when_it_answers(const Pose& X, const Twist& V) {
  constexpr double kLag =
      0.4;  // [s] of yaw and side forces behind the wheel angle; all library vehicles settle from 30 to 130 km/h
  const double quarter = 0.25 * kLag * V.w.z();
  const Quat half(math::cos(quarter), 0, 0, math::sin(quarter));
  return {X.p + half * Vec3(kLag * V.v), half * half * X.q};
}

/// How far the driver of a path has got along it, and the wheel angle.
struct OnTheWay {
  double reached = 0, steer = 0;  // [m], [rad]

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.reached, s.steer);
  }
};

/// Pure pursuit: the circle through the middle of the unsteered wheels, along the vehicle's axis, that meets the path a preview
/// ahead. Behind the end of the path the last segment goes on.
void steer_along_path(const Vehicle& vehicle, const Motion& state, double h, OnTheWay& driver) {
  const std::vector<Vec3>& path = vehicle.path.points;
  if (path.size() < 2) return;
  const Pose X = when_it_answers(state.X_WB[vehicle.body], state.V_WB[vehicle.body]);
  double front = 0, rear = 0, count_front = 0, count_rear = 0;
  for (const Wheel& wheel : vehicle.wheels) {
    (wheel.steered ? front : rear) += wheel.hub_B.x();
    (wheel.steered ? count_front : count_rear) += 1;
  }
  if (count_front == 0 || count_rear == 0) return;
  const double wheelbase = front / count_front - rear / count_rear;
  const Vec3 at = X * Vec3(rear / count_rear, 0, 0);
  // nearest point of the path, then the preview along it
  const double ahead = looks_ahead(vehicle.path, state.V_WB[vehicle.body].v.norm());
  auto [segment, share, distance, way] = place_on(vehicle.path, at, ahead, driver.reached);
  double left = ahead;
  for (;; ++segment, share = 0) {
    const double length = (path[segment + 1] - path[segment]).head<2>().norm();
    if (segment + 2 == path.size() || left <= (1 - share) * length) {
      share += left / length;
      break;
    }
    left -= (1 - share) * length;
  }
  const Vec3 goal_B = X.q.conjugate() * Vec3(path[segment] + share * (path[segment + 1] - path[segment]) - at);
  const double wanted = math::atan2(2 * wheelbase * goal_B.y(), goal_B.head<2>().squaredNorm());
  const double step = vehicle.path.rate * h;
  driver.steer =
      std::clamp(std::clamp(wanted, driver.steer - step, driver.steer + step), -vehicle.path.largest, vehicle.path.largest);
}

/// Share of its vehicle's load that a wheel carried in the last step; before the first one, at rest. `wheels`: of that vehicle.
double carried_share(std::span<const WheelState> wheels, const WheelState& of) {
  double all = 0, all_at_rest = 0;
  for (const WheelState& wheel : wheels) {
    all += wheel.impulse[0];
    all_at_rest += wheel.static_load;
  }
  return all > 0 ? of.impulse[0] / all : (all_at_rest > 0 ? of.static_load / all_at_rest : 0);
}

}  // namespace

double brake_of(const Vehicle& vehicle, int wheel, double t, double carried) {
  const double own = vehicle.brake_balance == BrakeBalance::loads ? carried : vehicle.wheels[wheel].brake_share;
  double force = std::clamp(vehicle.brake.at(t), 0.0, 1.0) * vehicle.brake_force * own;
  for (const DriverPhase& phase : vehicle.sequence)
    if (!phase.drives) force += phase.level_at(t) * phase.force * (phase.share.empty() ? own : phase.share[wheel]);
  return force;
}

double drive_of(const Vehicle& vehicle, int wheel, double t) {
  const auto driven = std::count_if(vehicle.wheels.begin(), vehicle.wheels.end(), [](const Wheel& w) { return w.driven; });
  const double own = vehicle.wheels[wheel].driven ? 1 / static_cast<double>(driven) : 0;
  double force = vehicle.drive_force.at(t) * own;
  for (const DriverPhase& phase : vehicle.sequence)
    if (phase.drives) force += phase.level_at(t) * phase.force * (phase.share.empty() ? own : phase.share[wheel]);
  return force;
}

/// Of drivers who follow a path.
struct DriverMemory {
  std::vector<OnTheWay> on_path;  // per vehicle

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.on_path);
  }
};

class Driver final : public EffectWith<DriverMemory> {
 public:
  static constexpr const char* kName = "driver";
  static Finding look(const Model& model) { return look_for_driver(model); }
  static LeftOut left_out(const Model& model, const Recording& run, bool) {
    LeftOut out = off_the_path(model, run);
    const std::string lean = look_for_driver(model).left_out;
    if (out.matters && !lean.empty()) out.text += "; " + lean;
    return out;
  }

  Driver(const World&, int self) : EffectWith(self) {}

  void begin(World& world, State& state) override {
    std::vector<OnTheWay>& on_path = memory(state).on_path;
    on_path.resize(world.model.vehicles.size());
    for (std::size_t v = 0; v < on_path.size(); ++v) {
      const Vehicle& vehicle = world.model.vehicles[v];
      if (vehicle.path.points.size() > 1) on_path[v].reached = start_on(vehicle.path.points, state.X_WB[vehicle.body]);
    }
  }

  void before_step(World& world, State& state, double step) override {
    std::vector<OnTheWay>& on_path = memory(state).on_path;
    for (std::size_t v = 0; v < world.model.vehicles.size(); ++v)
      steer_along_path(world.model.vehicles[v], state, step, on_path[v]);
    for (WheelState& wheel : state.wheels) {
      const Vehicle& vehicle = world.model.vehicles[wheel.vehicle];
      const std::span all(&wheel - wheel.wheel, vehicle.wheels.size());
      const bool follows = vehicle.path.points.size() > 1;
      wheel.steer = follows ? on_path[wheel.vehicle].steer : vehicle.steer.at(state.time);
      if (!vehicle.wheels[wheel.wheel].steered) wheel.steer = 0;
      wheel.brake = brake_of(vehicle, wheel.wheel, state.time, carried_share(all, wheel));
      wheel.drive = drive_of(vehicle, wheel.wheel, state.time);
    }
  }
};
template struct Registered<Driver>;

}  // namespace engine
