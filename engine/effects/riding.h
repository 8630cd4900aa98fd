// A rider and what it rides, before anything touches either: one rigid pair, upright in its plane, that the driver brakes, drives
// and steers.
#pragma once

#include "engine/step_context.h"

namespace engine {

/// Moves the pair of a person that waits on its mount through the step. Along: brake and drive of each wheel, up to friction times
/// what the wheel carries, which goes to the front axle as the pair slows, and the grade; a brake stops and does not push back.
/// Where a wheel would leave the road the driver holds back. Who neither brakes, drives nor steers keeps the speed, on a grade
/// too. Across: the circle of the wheel angle,
/// r = v tan(steer) / wheelbase, no narrower than friction allows. Lean is left out: it moves no wheel of a two-wheeler's track.
/// Wheels that lock are marked as such. Energy taken goes to the account of effect `self`, energy given to
/// the sources.
void ride(StepContext&, int person, int self);

/// What somebody who waits was given [J] beyond what gravity did, to the books.
void book(State&, int self, double given);

}  // namespace engine
