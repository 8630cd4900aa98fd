// A passenger car as curves along its length; sections between them are cubic B-splines.
#pragma once

#include "assets/generate/surface.h"

namespace assets {

/// Visual bodywork: windows, lamps, seams and wheel arches cut in, interior inside. Origin on the ground, middle of the wheelbase.
Surface bodywork();
/// Closed outer shell for contact, same frame.
Surface shell();

std::vector<Paint> car_paints();

}  // namespace assets
