// [[vehicle.wheel]], [vehicle.brake], [[vehicle.driver]], [vehicle.path]: what a vehicle rolls on, and what its driver does.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/loader/builder.h"

namespace scenes {
namespace {

const Key kWheelKeys[] = {
    bound<&engine::Wheel::name>({"name", Type::text, Dimension::none, kRequired, "Name, like front_left."}),
    bound<&engine::Wheel::hub_B>(
        {"at", Type::vector3, Dimension::length, kRequired, "Its centre at static load, in the mesh frame."}),
    bound<&engine::Wheel::radius>({"radius", Type::number, Dimension::length, "'0.31 m'", "Radius of the loaded tyre.", kPositive}),
    bound<&engine::Wheel::width>({"width", Type::number, Dimension::length, "'0.2 m'", "Width of the tyre.", kPositive}),
    bound<&engine::Wheel::spring>(
        {"spring", Type::number, Dimension::stiffness, "'25 kN/m'", "Suspension, at the wheel.", kPositive}),
    bound<&engine::Wheel::anti_roll>(
        {"anti_roll", Type::number, Dimension::stiffness, "'0 N/m'",
         "Anti-roll bar to the wheel on the other side: force at the wheel per difference of their travels.", kNotNegative}),
    bound<&engine::Wheel::rolling_resistance>({"rolling_resistance", Type::number, Dimension::none, "0",
                                               "Share of the load that resists rolling: 0.01 to 0.015 for car tyres.",
                                               kNotNegative}),
    bound<&engine::Wheel::damper>(
        {"damper", Type::number, Dimension::damping, "'2.5 kN s/m'", "Suspension, at the wheel.", kNotNegative}),
    bound<&engine::Wheel::travel>({"travel", Type::number, Dimension::length, "'0.1 m'", "Each way to the stop.", kPositive}),
    bound<&engine::Wheel::friction>({"friction", Type::number, Dimension::none, "0.8",
                                     "Tyre on the road; the ground's own friction limits it too.", kNotNegative}),
    bound<&engine::Wheel::tyre>({"tyre", Type::choice, Dimension::none, "'linear'",
                                 "Lateral force: linear in the slip angle up to the friction circle, or TM-Easy.", kAny,
                                 "linear|tm_easy"}),
    bound<&engine::Wheel::saturation_angle>({"saturation_angle", Type::number, Dimension::angle, "'10 deg'",
                                             "Linear tyre: the slip angle at which it reaches the friction circle.",
                                             between(0.001, 1.2)}),
    bound<&engine::Wheel::brake_share>({"brake_share", Type::number, Dimension::none, "",
                                        "Share of the brake force; the shares sum to 1. Left out at all wheels: by what each "
                                        "carries at the moment, so that all reach "
                                        "their limit together.",
                                        kShare}),
    bound<&engine::Wheel::steered>({"steered", Type::boolean, Dimension::none, "false", "Turns with steer."}),
    bound<&engine::Wheel::driven>({"driven", Type::boolean, Dimension::none, "false", "Takes its part of drive_force."}),
    {"mesh", Type::path, Dimension::none, "", "Its own mesh, like twin tyres, in place of the vehicle's wheel_mesh."},
};

/// What the first force of an act follows from.
struct Reaction {
  double from = 0, lag = 0;  // [s]
};

/// One braking by the driver.
struct Braking {
  double build_up = 0, deceleration = 0;  // [s], [m/s^2]
  std::optional<double> until;            // [s]
};

const Key kBrakeKeys[] = {
    bound<&Reaction::from>(
        {"from", Type::number, Dimension::time, "'0 s'", "When the pedal is pressed; may be negative: before the scene begins."}),
    bound<&Reaction::lag>({"lag", Type::number, Dimension::time, "'0 s'", "Until the first force.", kNotNegative}),
    bound<&Braking::build_up>(
        {"build_up", Type::number, Dimension::time, "'0.2 s'", "From the first force to the full one.", kNotNegative}),
    bound<&Braking::until>({"until", Type::number, Dimension::time, "", "When the pedal is let go; left out: never."}),
    bound<&Braking::deceleration>({"deceleration", Type::number, Dimension::acceleration, "'0.7 g'",
                                   "That the full brake force would give this mass; the tyres may give less.", kNotNegative}),
};

const Key kDriverKeys[] = {
    bound<&engine::DriverPhase::drives>(
        {"action", Type::choice, Dimension::none, "'brake'", "What is done. To coast needs no act.", kAny, "brake|accelerate"}),
    bound<&Reaction::from>(
        {"from", Type::number, Dimension::time, "'0 s'", "When it begins; may be negative: before the scene begins."}),
    bound<&Reaction::lag>({"lag", Type::number, Dimension::time, "'0 s'", "Reaction and lag until the first force.", kNotNegative}),
    bound<&engine::DriverPhase::build_up>(
        {"build_up", Type::number, Dimension::time, "'0.2 s'", "From the first force to the full one.", kNotNegative}),
    bound<&engine::DriverPhase::until>({"until", Type::number, Dimension::time, "", "When it ends; left out: never."}),
    bound<&engine::DriverPhase::force>(
        {"level", Type::number, Dimension::acceleration, "'0.7 g'",
         "That the full force would give this mass; the tyres may give less. Negative acceleration reverses."}),
    bound<&engine::DriverPhase::share>({"wheels", Type::numbers, Dimension::none, "",
                                        "Share of the force at each wheel in the order of the file; left out: as brake_share says, "
                                        "or evenly at the driven wheels."}),
};

struct PathPoint {
  engine::Vec3 at = engine::Vec3::Zero();  // [m] world
};

const Key kPathPointKeys[] = {
    bound<&PathPoint::at>({"at", Type::vector2, Dimension::length, kRequired, "World x, y."}),
};
const Section kPathPointSection{"vehicle.path.point", "[[vehicle.path.point]]", "A point of the path, in order.", kPathPointKeys};
const Key kPathKeys[] = {
    {"point", Type::tables, Dimension::none, "", "Two points or more.", kAny, {}, &kPathPointSection},
    bound<&engine::FollowedPath::preview>(
        {"preview", Type::number, Dimension::time, "'0.6 s'", "How far the driver looks ahead, at least two metres.", kPositive}),
    bound<&engine::FollowedPath::largest>(
        {"largest", Type::number, Dimension::angle, "'35 deg'", "Of the wheel angle.", between(0.01, 1.2)}),
    bound<&engine::FollowedPath::rate>(
        {"rate", Type::number, Dimension::angular_speed, "'35 deg/s'", "At which the wheel angle may change.", kPositive}),
};

}  // namespace

const Section kWheelSection{"vehicle.wheel", "[[vehicle.wheel]]", "A wheel.", kWheelKeys};
const Section kBrakeSection{"vehicle.brake", "[vehicle.brake]", "One braking by the driver.", kBrakeKeys};
const Section kDriverSection{"vehicle.driver", "[[vehicle.driver]]",
                             "One act of the driver. Acts may overlap: their forces add up.", kDriverKeys};
const Section kPathSection{"vehicle.path", "[vehicle.path]",
                           "A line on the ground that the driver steers along (pure pursuit), in place of steer.", kPathKeys};

void read_wheels(Reader& r, const engine::Vec3& cg, engine::Vehicle& vehicle) {
  double shares = 0;
  std::size_t given = 0;
  for (Reader& w : r.tables("wheel")) {
    engine::Wheel wheel;
    w.fill(wheel);
    wheel.hub_B -= cg;
    given += w.has("brake_share");
    shares += w.has("brake_share") ? wheel.brake_share : 0;
    vehicle.wheels.push_back(std::move(wheel));
  }
  if (given == 0) vehicle.brake_balance = engine::BrakeBalance::loads;
  if (given > 0 && given < vehicle.wheels.size())
    r.fail_here("has a brake_share at some of its wheels; give it at all, or at none");
  else if (given > 0 && std::abs(shares - 1) > 1e-6)
    r.fail_here(fmt::format("has brake shares that sum to {:.6g}, must sum to 1", shares));
}

void read_brake(Reader& r, double mass, engine::Vehicle& vehicle) {
  auto brake = r.table("brake");
  if (!brake) return;
  Reaction reaction;
  Braking braking;
  brake->fill(reaction);
  brake->fill(braking);
  vehicle.brake_force = mass * braking.deceleration;
  const double first = reaction.from + reaction.lag;
  const double full = first + braking.build_up;
  std::vector<engine::Schedule::Knot> knots{{first, 0}, {full, 1}};
  if (braking.until && *braking.until < full) {
    brake->fail("until", "must not be earlier than the end of the build-up");
  } else if (braking.until) {
    knots.push_back({*braking.until, 1});
    knots.push_back({*braking.until, 0});
  }
  vehicle.brake = engine::Schedule(std::move(knots));
}

void read_driver(Reader& r, double mass, engine::Vehicle& vehicle) {
  for (Reader& act : r.tables("driver")) {
    engine::DriverPhase phase;
    Reaction reaction;
    act.fill(phase);
    act.fill(reaction);
    phase.first_force = reaction.from + reaction.lag;
    if (phase.until < phase.first_force) act.fail("until", "must not be earlier than the first force");
    phase.force *= mass;
    if (!phase.drives && phase.force < 0) act.fail("level", "must not be negative for a brake");
    if (act.has("wheels")) {
      double sum = 0;
      for (const double share : phase.share) sum += share;
      if (phase.share.size() != vehicle.wheels.size())
        act.fail("wheels", fmt::format("must be {} numbers, one for each wheel", vehicle.wheels.size()));
      else if (sum > 1 + 1e-6 || *std::min_element(phase.share.begin(), phase.share.end()) < 0)
        act.fail("wheels", "must not be negative and not sum to more than 1");
    }
    vehicle.sequence.push_back(std::move(phase));
  }
  if (auto path = r.table("path")) {
    for (Reader& point : path->tables("point")) {
      PathPoint given;
      point.fill(given);
      vehicle.path.points.push_back(given.at);
      const auto n = vehicle.path.points.size();
      if (n > 1 && (vehicle.path.points[n - 1] - vehicle.path.points[n - 2]).norm() < 0.01)
        point.fail("at", "must be at least a centimetre from the point before");
    }
    if (vehicle.path.points.size() < 2) path->fail_here("has fewer than two points");
    if (r.has("steer")) r.fail("steer", "must not be given together with path");
    path->fill(vehicle.path);
  }
}

}  // namespace scenes
