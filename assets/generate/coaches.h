// Van, city bus and delivery truck. Origin on the ground, middle of the wheelbase.
#pragma once

#include "assets/generate/surface.h"

namespace assets {

Surface van();
Surface van_shell();
Surface bus();
Surface bus_shell();
Surface truck();
Surface truck_shell();

std::vector<Paint> van_paints();
std::vector<Paint> bus_paints();
std::vector<Paint> truck_paints();

}  // namespace assets
