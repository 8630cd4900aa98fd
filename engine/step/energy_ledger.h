// What every condition did to the energy of the bodies over the step.
#pragma once

#include "engine/step_context.h"

namespace engine {

/// How fast gravity alone would move each condition's rows over the step, through the joints: before work is asked for.
void note_pull(StepContext&);

/// Books the work of all conditions and of the joints' resistance.
void book(StepContext&);

/// Notes what effects that have no energy to give gave since StepBuffers::dissipated_before was filled.
void note_gains(StepContext&);

/// The most [J] that the mechanical energy of an island rose over the step beyond what its joints' resistance gave. Rigid contacts
/// and stops give none; but two segments that press on each other near a dead centre of the joints between them (chin and chest)
/// exchange impulses so large that the levers they turn meanwhile matter. Wheels and springs may give energy: of islands that have
/// any it is the work of the rigid contacts and stops that counts.
double largest_rise(StepContext&);

/// The most [J] that the books of a step are off by:
/// - what its impulses changed the mechanical energy by beyond the work of conditions and resistance. They act where the step
///   begins, and a pinched limb is displaced by so much that they would act otherwise where it ends;
/// - what the hard contacts and stops of one effect gave that has none to give, though others took it;
/// - what the wheels' springs hold more at its end than was done to press them. A tyre that finds itself on a limb that came from
///   the side is pressed in by nothing.
double mislaid(StepContext&);

}  // namespace engine
