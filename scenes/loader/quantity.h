// "40 km/h", "5 ft 9 in", "25 N/mm": a number with a unit, checked for its dimension, in SI.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scenes {

enum class Dimension {
  none,
  length,
  mass,
  time,
  angle,
  speed,
  angular_speed,
  acceleration,
  force,
  stiffness,
  damping,
  torque,
  angular_stiffness,
  angular_damping,
  inertia,
  density
};

/// Powers of metre, kilogram, second, radian: what a product of units is.
struct Powers {
  int m = 0, kg = 0, s = 0, rad = 0;
  bool operator==(const Powers&) const = default;
};
Powers powers_of(Dimension);

/// One unit by its symbol ("km", "mph"): what it is in SI. "g" is a gram here.
struct UnitSize {
  double factor = 1;
  Powers powers;
};
std::optional<UnitSize> unit_named(std::string_view symbol);

/// The dimension whose SI unit is written so; asserts that there is one.
Dimension dimension_of(std::string_view si_unit);

/// The name of a dimension ("speed"), its SI unit ("m/s"), and the unit people write ("km/h").
std::string_view name_of(Dimension);
std::string_view si_unit(Dimension);
std::string_view usual_unit(Dimension);

struct Quantity {
  double value = 0;              // SI
  std::string problem;           // empty: understood. Else what is wrong, to follow "key is VALUE: "
  std::optional<double> bare{};  // the number, where only its unit is missing
};

/// Reads `text` as a quantity of the dimension. "g" is the acceleration of gravity (9.81 m/s^2) where an acceleration is asked for,
/// else grams.
Quantity parse_quantity(std::string_view text, Dimension);

/// "1 2 3 m": several numbers that share one unit. `problem` as above.
struct Quantities {
  std::vector<double> values;
  std::string problem;
};
Quantities parse_quantities(std::string_view text, Dimension);

/// What to write in place of the bare number: `"40 km/h" or "11.1 m/s"`. Where that is not within lower..upper (SI), the number in
/// the units that are: `"178 cm"`.
std::string unit_examples(double number, Dimension, double lower = -std::numeric_limits<double>::infinity(),
                          double upper = std::numeric_limits<double>::infinity());

}  // namespace scenes
