// The skin of a passenger car: curves along its length; sections between them are cubic B-splines.
#pragma once

#include "assets/generate/curve.h"
#include "assets/generate/surface.h"

namespace assets {

struct CarShape {
  double front, rear;  // [m] ends of the car
  double half_width;   // [m]
  double roof_half;    // [m] half width at the roof's rails
  double waist;        // [m] height of the widest place, at the most
  Curve top;           // outline over the middle
  Curve shoulder;      // line below the windows
  Curve underside;
  double nose = 5.0, tail = 6.0;  // [-] exponents of the ends in plan: larger is blunter
};

/// At the ends, where a section is lower than its bends want, the skin folds: hidden in a picture, but contact must have none.
enum class Folds { hidden, none };

/// Half of the outer skin, y >= 0, of material paint.
Surface half_skin(const CarShape&, int stations, int around, Folds = Folds::hidden);

}  // namespace assets
