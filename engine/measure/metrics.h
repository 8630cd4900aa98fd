// What a reconstructionist reads off a Recording. Keys are those of summary.json; a measure that the run does not define is absent.
#pragma once

#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

struct Metric {
  std::string key;      // "throw_distance_m": the unit stands in the key
  std::string object;   // person, body or vehicle it belongs to
  double value = 0;     // SI
};

/// Everything below, for every object of the model.
std::vector<Metric> measure(const Model&, const Recording&);

/// Of a person. Throw: centre of mass from the first vehicle contact to rest (or the end of the run), horizontally; along and across
/// the vehicle's heading at that moment. Airborne: from leaving the vehicle to the first ground contact. Slide: from there to rest.
void measure_throw(const Model&, const Recording&, int person, std::vector<Metric>&);

/// Of a person's head: time and speed of its impact on a vehicle (relative speed of centre of head and vehicle's surface there).
void measure_head(const Model&, const Recording&, int person, std::vector<Metric>&);

/// Of free bodies: distance travelled from start to end, height of the first rebound.
void measure_body(const Model&, const Recording&, int body, std::vector<Metric>&);

/// Of a vehicle: change of velocity by contacts over the whole run.
void measure_vehicle(const Model&, const Recording&, int vehicle, std::vector<Metric>&);

/// Head injury criterion: max over windows of at most `window` [s] of (t2 - t1) (mean of a)^2.5, a in g at equally or unequally
/// spaced `times`, piecewise linear between them. Exact at the samples: windows begin and end on them.
double hic(const std::vector<double>& times, const std::vector<double>& acceleration_g, double window);

/// Largest level [g] that is held for 3 ms without a break, acceleration piecewise linear.
double three_ms_clip(const std::vector<double>& times, const std::vector<double>& acceleration_g);

/// Why head injury measures are absent, empty if they are there: rigid impacts exchange impulses in no time, an acceleration that
/// could be integrated does not exist.
std::string why_no_head_injury(const Model&);

}  // namespace engine
