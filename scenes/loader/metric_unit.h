// Units as the keys of summary.json end in them.
#pragma once

#include <numbers>
#include <string_view>

#include "scenes/loader/quantity.h"

namespace scenes {

struct MetricUnit {
  Dimension dimension;
  std::string_view suffix;
  double per_si;  // what one SI unit is in it
};

constexpr MetricUnit kMetricUnits[] = {
    {Dimension::length, "_m", 1},
    {Dimension::time, "_s", 1},
    {Dimension::speed, "_mps", 1},
    {Dimension::angle, "_deg", 180 / std::numbers::pi},
    {Dimension::acceleration, "_g", 1 / 9.81},
    {Dimension::none, "", 1},
};

}  // namespace scenes
