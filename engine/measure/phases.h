// A throw and its phases: contact, carried, flight or fall, landing, slide, rest.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/measure/parties.h"

namespace engine {

/// One phase, from its beginning to the beginning of the next.
struct ThrowPhase {
  const char* name = "";      // "contact", "carried", "flight", "fall", "landing", "slide", "rest"
  double from = 0, to = 0;    // [s]
  Vec3 place = Vec3::Zero();  // [m] world: the centre of mass where it begins
  double distance = 0;        // [m] of the centre of mass along the line of the throw; the distances of all phases sum to the throw
};

/// What befell somebody or something that was struck.
struct Throw {
  double hit = 0;                   // [s] first touch with a vehicle, of the person or of what it rides
  int vehicle = -1;                 // body that gives `along` its direction
  std::optional<double> separated;  // [s] last push of a vehicle before landing
  std::optional<double> landed;     // [s] the trunk came down on the ground
  std::optional<double> rest;       // [s]
  double end = 0;                   // [s] rest, or the end of the run
  bool flew = false;                // nothing touched or held it for 50 ms or more between the last push and landing
  bool lay = false;                 // struck as it lay on the ground, and not thrown off it: it does not land
  bool dragged = false;             // a vehicle that moved pushed it again after it had come down
  Vec3 along = Vec3::UnitX();       // unit, level: the way of the faster vehicle at the first touch
  Vec3 thrown = Vec3::Zero();       // [m] of the centre of mass from hit to end, level
  std::vector<ThrowPhase> phases;   // in order; one that did not happen is not there
};

/// The throw of a person; nothing where no vehicle touched it or what it rides.
///
/// contact: from the first touch until its centre moves along the throw as fast as the vehicle. carried: from there to the last
/// push of a vehicle before it lands (to the end, if it never lands); a person who never reaches the vehicle's speed has contact
/// alone; a rider is off when the last joint with what it rode has broken. flight: from there to landing, if nothing touched it for
/// 50 ms or more; else fall, as of who comes down over a hand or a foot. landing: from the trunk's touch of the ground until
/// something of the person touches the ground without a break of 50 ms. slide: from there to rest, or the end of the run. A phase
/// that takes no time is not there.
std::optional<Throw> throw_of_person(const Model&, const Recording&, int person);

/// The same of what somebody rides, which has no trunk: one phase from its first touch to its rest.
std::optional<Throw> throw_of_mount(const Model&, const Recording&, int person);

}  // namespace engine
