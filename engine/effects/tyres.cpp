// Wheels: a suspension spring and damper under each hub, and a tyre that holds what the friction circle allows. Both are rows of
// the one impulse solve, the spring soft (implicit), so a braked car stands on a slope without creeping.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/contact/mean_friction.h"
#include "engine/contact/road.h"
#include "engine/contact/round_tyre.h"
#include "engine/effects/footing.h"
#include "engine/effects/registration.h"
#include "engine/effects/static_loads.h"
#include "engine/effects/words.h"
#include "engine/laws/tyre.h"
#include "engine/math/functions.h"
#include "engine/solver/free_response.h"

namespace engine {
namespace {

constexpr double kStopStiffness = 10;  // [-] times the spring's, beyond the travel

Finding look_for_tyres(const Model& model) {
  std::size_t count = 0;
  double low = std::numeric_limits<double>::infinity(), high = 0;
  std::vector<std::string> names;
  for (const Vehicle& vehicle : model.vehicles) {
    count += vehicle.wheels.size();
    if (!vehicle.wheels.empty()) names.push_back(vehicle.name);
    for (const Wheel& wheel : vehicle.wheels) {
      low = std::min(low, wheel.friction);
      high = std::max(high, wheel.friction);
    }
  }
  if (model.vehicles.empty()) return {false, "no vehicle", ""};
  if (count == 0) return {false, "no vehicle with wheels", ""};
  const bool deck = std::any_of(model.bodies.begin(), model.bodies.end(), [](const Body& body) { return body.fixed; });
  if (!model.ground.plane && !model.ground.terrain && !deck)
    return {false, counted(count, "wheel") + ", but no ground to roll on", ""};
  const std::string friction = low == high ? number(low) : number(low) + " to " + number(high);
  const std::string over = tyre_pairs(model).empty() ? "" : "; they roll over persons and free bodies too";
  return {true, counted(count, "wheel") + " of " + listed(names) + ", tyre friction " + friction + over, ""};
}

/// Spring force [N] at a compression, stop included.
double spring_force(const Wheel& spec, double static_load, double compression) {
  const double beyond = std::max(0.0, std::abs(compression) - spec.travel);
  return static_load + spec.spring * (compression + std::copysign(kStopStiffness * beyond, compression));
}

/// How far the wheel hangs below static ride [m]: where spring and rebound stop balance. Lower it gives no force.
double droop_of(const Wheel& spec, double static_load) {
  const double slack = static_load / spec.spring;
  return slack <= spec.travel ? slack : (slack + kStopStiffness * spec.travel) / (1 + kStopStiffness);
}

double spring_energy(const Wheel& spec, double static_load, double compression) {
  const double beyond = std::max(0.0, std::abs(compression) - spec.travel);
  return static_load * compression + 0.5 * spec.spring * (compression * compression + kStopStiffness * beyond * beyond);
}

Grip grip_of(const Wheel& spec, const WheelState& wheel, double load, double mu, double v_x, double v_y) {
  switch (spec.tyre) {
    case TyreModel::tm_easy:
      return tm_easy_grip(passenger_car_tyre(wheel.static_load), load, mu, v_x, v_y, wheel.brake + std::abs(wheel.drive));
    case TyreModel::linear:
      break;
  }
  return linear_grip(load, mu, spec.friction, spec.saturation_angle, v_x, v_y);
}

/// How much further the wheel is pressed in than the one on the other side of its axle [m]; 0 for one that has no bar or no mate.
double leaning(const Model& model, const WheelState& wheel) {
  const std::vector<Wheel>& all = model.vehicles[wheel.vehicle].wheels;
  const Wheel& spec = all[wheel.wheel];
  if (spec.anti_roll <= 0) return 0;
  constexpr double kSameAxle = 0.05;               // [m]
  const WheelState* first = &wheel - wheel.wheel;  // a vehicle's wheels stand one after the other
  for (std::size_t i = 0; i < all.size(); ++i)
    if (std::abs(all[i].hub_B.x() - spec.hub_B.x()) < kSameAxle && all[i].hub_B.y() * spec.hub_B.y() < 0)
      return wheel.compression - first[i].compression;
  return 0;
}

void add_wheel(StepContext& step, const WheelState& wheel, const Footing& footing, int index, int self) {
  const World& world = step.world;
  const State& state = step.state;
  const Vehicle& vehicle = world.model.vehicles[wheel.vehicle];
  const Wheel& spec = vehicle.wheels[wheel.wheel];
  const Pose& X = state.X_WB[vehicle.body];
  const double h = step.length;
  const double stiffness = spec.spring * (std::abs(wheel.compression) > spec.travel ? 1 + kStopStiffness : 1);
  const double force = spring_force(spec, wheel.static_load, wheel.compression) + spec.anti_roll * leaning(world.model, wheel);

  Constraint c;
  c.kind = ConstraintKind::wheel;
  const auto moves = [&](int body) { return body >= 0 && world.awake[body]; };
  c.a.body = vehicle.body;
  c.b.body = moves(footing.body) ? footing.body : -1;
  c.a.record = vehicle.body;
  // what stands fast under a wheel is road: nobody is struck, and it leaves its mark there
  const bool road = footing.body < 0 || (world.model.bodies[footing.body].fixed && world.model.bodies[footing.body].person < 0);
  c.b.record = road ? -1 : footing.body;
  c.point = footing.point;
  const Vec3 forward = X.q * Vec3(math::cos(wheel.steer), math::sin(wheel.steer), 0);
  const Vec3 t1 = (forward - forward.dot(footing.normal) * footing.normal).normalized();
  c.frame << footing.normal, t1, footing.normal.cross(t1);
  const Vec3 r = c.point - X.p;
  for (int k = 0; k < 3; ++k) c.a.J.row(k) << c.frame.col(k).transpose(), r.cross(c.frame.col(k)).transpose();
  // the strut carries N cos(lean) of the load N, a guide the rest, and gives way by 1/cos(lean) of the way to the ground
  const double facing = footing.normal.dot(X.q * Vec3::UnitZ());
  const double implicit = stiffness * h + spec.damper;
  c.softness = facing * facing / (h * implicit);
  c.target = facing * force / implicit;
  Vec3 v = state.V_WB[vehicle.body].v + state.V_WB[vehicle.body].w.cross(r);
  double under = mean_friction(world.model.ground, {c.point, v, state.time, h});
  if (footing.body >= 0) {
    const Vec3 r_b = c.point - state.X_WB[footing.body].p;
    for (int k = 0; k < 3; ++k) c.b.J.row(k) << -c.frame.col(k).transpose(), -r_b.cross(c.frame.col(k)).transpose();
    v -= state.V_WB[footing.body].v + state.V_WB[footing.body].w.cross(r_b);
    const Body& body = world.model.bodies[footing.body];
    // clothes hold rubber as they hold a road; bodywork they slide on
    under = (body.person >= 0 ? body.surface.friction_ground : body.surface.friction_body).at(state.time);
  }
  c.response.free = free_response(world.model, state.X_WB, c, 0);
  const double mu = std::min(spec.friction, under);
  const Grip grip = grip_of(spec, wheel, std::max(0.0, force), mu, t1.dot(v), c.frame.col(2).dot(v));
  c.surface.friction = grip.friction;
  c.wheel.grip_softness = grip.damping > 0 ? 1 / (h * grip.damping) : 0;
  c.wheel.braking = h * (wheel.brake + spec.rolling_resistance * std::max(0.0, force));
  c.wheel.driving = h * wheel.drive;
  c.gap = -wheel.compression;
  c.key = (static_cast<std::uint64_t>(self) << 56) | static_cast<std::uint64_t>(index);
  c.effect = self;
  c.wheel.index = index;
  step.constraints.push_back(c);
}

/// Part of a wheel's longitudinal impulse that the engine gave: all it offered, unless the tyre slipped.
double engine_share(const Constraint& c) {
  const double most =
      std::abs(c.impulse[1] - c.wheel.driving) <= c.wheel.braking * (1 + 1e-9) ? std::abs(c.wheel.driving) : std::abs(c.impulse[1]);
  return std::copysign(std::min(std::abs(c.wheel.driving), most), c.wheel.driving);
}

}  // namespace

/// A strut whose wheel goes from its tread over onto its flank, and comes back. The step in which it leaves the tread moves the
/// strut to its end. Nothing moves along it on the flank, so it goes on from where it stood: what the road then asks of it beyond
/// that is slack, which only lessens.
struct StrutMemory {
  bool stood = false;  // on its tread at the last look
  bool lying = false;  // on its flank
  double slack = 0;    // [m]

  /// How far the strut is pressed in on this footing, where it was by `before` [m].
  double pressed(const Footing& footing, double before, double droop) {
    if (lying && footing.found) slack = std::max(0.0, footing.compression - before);
    const bool left = stood && footing.near && !footing.found;
    lying = footing.near && !footing.found;
    stood = footing.found;
    if (lying && !left) return before;
    const double asked = left ? footing.leaving : footing.compression;
    slack = std::min(slack, std::max(0.0, asked + droop));
    return asked - slack;
  }
  template <class S>
  static auto fields(S& s) {
    return std::tie(s.stood, s.lying, s.slack);
  }
};
struct TyresMemory {
  std::vector<StrutMemory> struts;  // as State::wheels

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.struts);
  }
};

class Tyres final : public EffectWith<TyresMemory> {
 public:
  static constexpr const char* kName = "tyres";
  static Finding look(const Model& model) { return look_for_tyres(model); }
  static Staged staged(const Model&) { return {false, "wheels"}; }

  Tyres(World& world, int self) : EffectWith(self) {
    ContactPairs& pairs = world.pairs;
    pairs.tyres = tyre_pairs(world.model);
    pairs.roads = roads_of(world.model);
    for (std::size_t i = 0; i < pairs.tyres.size(); ++i) pairs.in_reach.tyres.push_back(i);
  }

  void begin(World& world, State& state) override {
    const std::vector<double> loads = static_wheel_loads(world.model, world.topology);
    for (int v = 0; v < static_cast<int>(world.model.vehicles.size()); ++v)
      for (int w = 0; w < static_cast<int>(world.model.vehicles[v].wheels.size()); ++w) {
        WheelState wheel;
        wheel.vehicle = v;
        wheel.wheel = w;
        wheel.static_load = loads[state.wheels.size()];
        state.wheels.push_back(wheel);
      }
    memory(state).struts.resize(state.wheels.size());
  }

  void before_step(World&, State& state, double) override { note_start(state); }

  /// Every attempt at a step looks alike at its start, as far as the step before it took the wheels: what an attempt saw is
  /// forgotten.
  void find(StepContext& step) override {
    World& world = step.world;
    State& state = step.state;
    begin_again(state);
    const Outlook outlook{world, state, state, state.pace.last};
    book_springs(state, stand(outlook, state.wheels, memory(state).struts));
    for (std::size_t i = 0; i < footings_.size(); ++i) {
      WheelState& wheel = state.wheels[i];
      wheel.impulse.setZero();
      const bool acts = footings_[i].found && world.awake[world.model.vehicles[wheel.vehicle].body];
      if (acts) add_wheel(step, wheel, footings_[i], static_cast<int>(i), self_);
    }
  }

  double stored(StepContext& step) override {
    at_end_ = step.state.wheels;
    struts_at_end_ = memory(step.state).struts;
    stored_ = stand({step.world, step.state, step.end, step.length}, at_end_, struts_at_end_);
    return stored_;
  }

  void after_step(StepContext& step) override {
    State& state = step.state;
    for (const Constraint& c : step.constraints) {
      if (c.kind != ConstraintKind::wheel) continue;
      WheelState& wheel = state.wheels[c.wheel.index];
      const Wheel& spec = step.world.model.vehicles[wheel.vehicle].wheels[wheel.wheel];
      wheel.impulse = c.impulse;
      const double grip = c.surface.friction * c.impulse[0];
      const bool sliding = math::hypot(c.impulse[1], c.impulse[2]) >= 0.999 * grip && grip > 0;
      wheel.locked = sliding && wheel.brake > 0 && std::abs(c.impulse[1] - c.wheel.driving) < 0.999 * c.wheel.braking;
      wheel.slip = sliding && c.b.record < 0 ? math::hypot(wheel.locked ? c.u.after[1] : 0.0, c.u.after[2]) : 0;
      if (!wheel.locked) state.wheel_spin[c.wheel.index] += step.length * c.u.after[1] / spec.radius;
      // the engine's work is a source, not a loss: the books took it with the whole impulse
      const double work = engine_share(c) * 0.5 * (c.u.before[1] + c.u.after[1]);
      state.energy.added += work;
      state.energy.dissipated[c.effect] += work;
    }
    book_springs(state, stored_);  // now, and not at the start of the next step: its length may be another
  }

 private:
  void note_start(State& state) {
    at_start_.clear();
    for (const WheelState& wheel : state.wheels) at_start_.emplace_back(wheel.compression, wheel.lift);
    struts_at_start_ = memory(state).struts;
  }

  void begin_again(State& state) {
    if (at_start_.size() != state.wheels.size()) note_start(state);  // the look of a run that begins
    for (std::size_t i = 0; i < at_start_.size(); ++i) std::tie(state.wheels[i].compression, state.wheels[i].lift) = at_start_[i];
    memory(state).struts = struts_at_start_;
  }

  /// Where the wheels stand, to `wheels`, and what they stand on; returns what their springs hold [J].
  double stand(const Outlook& outlook, std::vector<WheelState>& wheels, std::vector<StrutMemory>& struts) {
    World& world = outlook.world;
    footings_.clear();
    const std::vector<std::size_t>& in_reach = world.pairs.in_reach.tyres;
    auto pair = in_reach.begin();
    double energy = 0;
    for (int i = 0; i < static_cast<int>(wheels.size()); ++i) {
      WheelState& wheel = wheels[i];
      const Vehicle& vehicle = world.model.vehicles[wheel.vehicle];
      const Wheel& spec = vehicle.wheels[wheel.wheel];
      const Pose& X = outlook.at.X_WB[vehicle.body];
      const Vec3 up = X.q * Vec3::UnitZ();
      const double droop = droop_of(spec, wheel.static_load);
      Footing footing = footing_of(outlook, i, droop);
      const auto first = pair;
      while (pair != in_reach.end() && world.pairs.tyres[*pair].wheel == i) ++pair;
      step_on_bodies(outlook, {first, pair}, footing);
      wheel.compression = struts[static_cast<std::size_t>(i)].pressed(footing, wheel.compression, droop);
      wheel.lift = std::clamp(wheel.compression, -droop, 2 * spec.travel);
      wheel.hub = X * spec.hub_B + wheel.lift * up;
      wheel.contact = footing.found ? footing.point : Vec3(wheel.hub - spec.radius * up);
      energy += spring_energy(spec, wheel.static_load, wheel.compression);
      footings_.push_back(footing);
    }
    for (const WheelState& wheel : wheels) {
      const double twist = leaning(world.model, wheel);
      energy +=
          0.25 * world.model.vehicles[wheel.vehicle].wheels[wheel.wheel].anti_roll * twist * twist;  // half of the bar's for each
    }
    return energy;
  }

  /// What the springs took or gave since the last look is not lost: it leaves the dampers' account.
  void book_springs(State& state, double energy) const {
    state.energy.dissipated[self_] -= energy - state.energy.springs;
    state.energy.springs = energy;
  }

  double stored_ = 0;                                // [J] at its end
  std::vector<std::pair<double, double>> at_start_;  // [m] compression and lift where the step begins
  std::vector<WheelState> at_end_;
  std::vector<StrutMemory> struts_at_start_, struts_at_end_;
  std::vector<Footing> footings_;  // of the step at hand; room is kept from step to step
};
template struct Registered<Tyres>;

}  // namespace engine
