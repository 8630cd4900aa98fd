// The table of impacts: one row a collision phase of a vehicle with a vehicle, a person or an object, and of a person with an
// object or another person.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/measure/parties.h"

namespace engine {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();  // what a row cannot say

/// First and last snapshot whose contacts belong to a phase.
struct Stretch {
  std::size_t first = 0, last = 0;
};

/// What one of the two did.
struct ImpactSide {
  Party party;
  std::string name;
  int part = -1;                                                 // body that was touched first
  double speed_before = kUnknown, speed_after = kUnknown;        // [m/s] of the centre of mass
  double yaw_rate_before = kUnknown, yaw_rate_after = kUnknown;  // [rad/s] about the vertical
  // [m/s] world; in the plane of the road where a vehicle takes part. Of a vehicle the change of velocity in the phase, less what
  // tyres and gravity did meanwhile: what a third one did is in it. Of others what all who struck it gave it meanwhile: who stands
  // or lies is borne by the ground, and that is no blow.
  Vec3 delta_v = Vec3::Zero();
  Vec3 own_delta_v = Vec3::Zero();  // [m/s] world: impulse of this pair alone over the mass
  double pdof = kUnknown;           // [deg] vehicles only, and only of one that stands on its wheels
  double ees = kUnknown;            // [m/s] vehicles only
  int phases = 1;                   // that delta_v is of
};

/// One collision phase. It begins with the first touch of a stretch in which the two exchange more than 0.8 km/h times the lighter
/// mass within 20 ms, and ends when they no longer do, after 250 ms at most (49 CFR 563.5 and 563.7, which define the event and the
/// delta-v of event data recorders so). With a vehicle and without a person one of the two must change its velocity by as much: who
/// shoves another one along at one speed, against its tyres, collides no further. Two that never exchange as much have one phase of
/// a tenth of the most they do. Without a vehicle there is a phase only where one of the two changes its velocity along the push by
/// more than 0.8 km/h: who stands on a box is not struck by it. Nor is who holds something, for as long as it is held, or who comes
/// down on what is fixed.
struct Impact {
  int phase = 1;  // of this pair, from 1
  Stretch span;
  double time = 0;      // [s] first touch; of Kudlich-Slibar the instant of the exchange, later by its compression time
  double duration = 0;  // [s] 0 of an exchange at one instant
  ImpactSide a, b;
  const char* law = "";              // "kudlich_slibar", "default_auto", "compliant"
  Vec3 point = Vec3::Zero();         // [m] world, mean by impulse
  Vec3 normal = Vec3::UnitZ();       // unit, from b to a: of the contact plane, mean by impulse
  double closing_speed = kUnknown;   // [m/s] along the normal at the point, before; with a person those of the first touch. Of two
                                     // that touch already, and do not close, there is none
  double relative_speed = kUnknown;  // [m/s] of which that is the part along the normal
  Vec3 impulse = Vec3::Zero();       // [N s] on a, world
  double friction_used = kUnknown;   // [-] tangential over normal impulse, each contact along its own surface
  double friction_limit = kUnknown;  // [-] most it could have been: coefficient of the surfaces and what a dent adds
  double energy_lost = 0;            // [J] deformation and friction between the two. Unknown where more came back: what an
                                     // earlier phase stored, or what pushing a depth apart gave
  const char* ees_rule = "";         // how that was shared: "by stiffness", "by mass", "all to the one that moves"
  const char* no_ees = "";           // why none is told of either; empty: it is
};

constexpr double kChange = 0.8 / 3.6;  // [m/s] within 20 ms: more is a collision
constexpr double kWindow = 0.02;       // [s] 49 CFR 563.5, end of event time
constexpr double kLongest = 0.25;      // [s] 49 CFR 563.7, delta-v is recorded from 0 to 250 ms

/// What a stretch of the recording did to a party. Of others than vehicles without delta-v.
ImpactSide side_of(const Model&, const Recording&, const Party&, const Stretch&);

/// By how much [m/s] a party's level velocity differs 20 ms on from what it was before a snapshot.
double changes_within_window(const Model&, const Recording&, const Party&, std::size_t first);

/// The phases of a series of pushes [N s], one a snapshot: those in which more than `bound` [N s] is exchanged within 20 ms. Where
/// `changes` is given, and anything changes at all, only from snapshots on from which it is true.
std::vector<Stretch> stretches(const Recording&, const std::vector<Vec3>& push, double bound,
                               const std::function<bool(std::size_t)>& changes = {});

/// In order of time.
std::vector<Impact> impacts_of(const Model&, const Recording&);

/// The recorded events, and a "collision" where two have their first phase that have no event of their own: all but a person and a
/// vehicle, which have their first contact. `value` is the closing speed. In order of time.
std::vector<Event> told_events(const Model&, const Recording&);

}  // namespace engine
