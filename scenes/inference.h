// What a scene says of what is not known of it, and of what was seen: [[uncertain]] and [[evidence]].
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/math/types.h"

namespace scenes {

enum class Spread { uniform, normal, triangular, log_normal, choice, table };

/// A unit as its author wrote it: so results are told.
struct WrittenUnit {
  std::string name;   // "km/h"; empty: a plain number
  double factor = 1;  // SI of one of it
};

/// A value of the scene that is known only so far.
struct Uncertain {
  std::string key;      // "vehicle.sedan.speed"
  std::string si_unit;  // "m/s"; what an override with a number in SI has to end in
  WrittenUnit unit;
  Spread spread = Spread::uniform;
  /// SI. uniform: ends; normal: mean, standard deviation; triangular: least, likeliest, most; log_normal: median, factor (a plain
  /// number above 1); table: values in rising order.
  std::vector<double> numbers;
  std::vector<std::string> choices;  // as an override writes them
  std::vector<double> weights;       // choice: of each, sum 1; table: density at each value, straight lines between them
  double lower = -std::numeric_limits<double>::infinity();  // nothing outside is possible, SI
  double upper = std::numeric_limits<double>::infinity();
  std::vector<std::pair<std::string, double>> correlation;  // other key, correlation of the normal scores
  std::string place;                                        // file:line:column

  bool bounded() const { return spread == Spread::uniform || spread == Spread::triangular || spread == Spread::table; }
};

/// What a piece of evidence is compared with.
enum class Seen { metric, rest_place, landing_place, contact_place, speed, mark, contact, no_contact };

struct Evidence {
  std::string name;
  Seen seen = Seen::metric;
  std::string metric;              // Seen::metric: as in summary.json, "throw_distance_m"
  std::string of;                  // person, vehicle or body, or a part of a person; empty: the only one
  std::string with;                // contact_place, contact, no_contact: the other one
  double at = 0;                   // [s] speed
  std::vector<double> value;       // in the metric's own unit (SI for all others); places have two or three components
  double tolerance = 0;            // one standard deviation of what may be off, same unit
  std::vector<engine::Vec3> mark;  // [m] polyline, world
  WrittenUnit unit;                // factor: the metric's own unit of one of it
  std::string place;               // file:line:column
};

struct Inference {
  std::vector<Uncertain> uncertain;
  std::vector<Evidence> evidence;
};

}  // namespace scenes
