// The units a scene may be written in, and what is said of each kind of quantity.
#pragma once

#include <span>
#include <string_view>

#include "scenes/loader/quantity.h"

namespace scenes {

struct DimensionLine {
  std::string_view name, si, usual, second;  // `second`: the other way to write it, for the remedy
  Powers powers;
  std::string_view units = {};  // those people use, for the remedy
};

const DimensionLine& line(Dimension);

struct Unit {
  std::string_view symbol;
  double factor;
  Powers powers;
};
std::span<const Unit> all_units();

}  // namespace scenes
