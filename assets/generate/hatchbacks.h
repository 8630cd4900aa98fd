// Cars with an upright tail: a small one and one for rough roads. Origin on the ground, middle of the wheelbase.
#pragma once

#include "assets/generate/surface.h"

namespace assets {

Surface small_car();
Surface small_car_shell();
Surface suv();
Surface suv_shell();

std::vector<Paint> small_car_paints();
std::vector<Paint> suv_paints();

}  // namespace assets
