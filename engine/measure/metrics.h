// What a reconstructionist reads off a Recording. Keys are those of summary.json; a measure that the run does not define is absent.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

struct Metric {
  std::string key;     // "throw_distance_m": the unit stands in the key
  std::string object;  // person, body or vehicle it belongs to
  double value = 0;    // SI
};

/// A measure people ask for and this run cannot define, with the reason in a sentence.
struct AbsentMetric {
  std::string key;
  std::string object;
  std::string reason;
};

/// Everything below, for every object of the model.
std::vector<Metric> measure(const Model&, const Recording&);

/// Of a person. Throw: centre of mass from the first vehicle contact to rest (or the end of the run), horizontally; along and
/// across the vehicle's heading at that moment. Airborne: from leaving the vehicle to the first ground contact. Slide: from there
/// to rest.
void measure_throw(const Model&, const Recording&, int person, std::vector<Metric>&);

/// Of a person's head at its first impact on a vehicle: time; speed of the head's centre relative to the vehicle's surface at the
/// place of impact, taken at the last snapshot before it; wrap-around distance, if the vehicle came with its front.
void measure_head(const Model&, const Recording&, int person, std::vector<Metric>&);

/// Of every part of a person: largest acceleration of its centre, mean over a step, free fall counting one g. Only with the
/// compliant law: a rigid impact changes velocities in an instant.
void measure_segments(const Model&, const Recording&, int person, std::vector<Metric>&);

/// Length [m] of a taut tape in the vertical longitudinal plane through the head's impact `point_B` (body axes of the vehicle):
/// from the ground straight up in front of the foremost part, over the front and bonnet, to the point. The contour is the
/// silhouette of the collision mesh within 0.15 m to either side; a taut tape bridges hollows, so it is that silhouette's convex
/// outline. The ground is where the wheels stand at static load, as on a vehicle measured at rest. Absent if the body is no vehicle
/// or has no mesh there.
std::optional<double> wrap_around_distance(const Model&, int body, const Vec3& point_B);

/// Of free bodies: distance travelled and angle between the attitudes (0..180 deg) from start to end, time of rest, height of the
/// first rebound (of the body's lowest point above the ground).
void measure_body(const Model&, const Recording&, int body, std::vector<Metric>&);

/// Of a vehicle: delta_v_mps, the sum of all contact impulses but those of tyres and ground over the whole run, by its mass
/// (couplings carry part of it on, so that of a vehicle with a trailer is an upper bound); pdof_deg, the direction the force came
/// from in the vehicle's axes at first contact: 0 from the front, positive from the right, 90 square on the right side, 180 from
/// behind. Neither without contact. ees_mps, the speed whose kinetic energy is the vehicle's share of the energy lost in
/// Kudlich-Slibar impacts (half between two vehicles, all against a fixed barrier); absent where there was none.
void measure_vehicle(const Model&, const Recording&, int vehicle, std::vector<Metric>&);

/// Head injury criterion: max over windows of at most `window` [s] of (t2 - t1) (mean of a)^2.5, a in g at equally or unequally
/// spaced `times`, piecewise linear between them. Exact at the samples: windows begin and end on them.
double hic(const std::vector<double>& times, const std::vector<double>& acceleration_g, double window);

/// Largest level [g] that is held for 3 ms without a break, acceleration piecewise linear.
double three_ms_clip(const std::vector<double>& times, const std::vector<double>& acceleration_g);

/// Why head injury measures are absent, empty if they are there: rigid impacts exchange impulses in no time, an acceleration that
/// could be integrated does not exist.
std::string why_no_head_injury(const Model&);

/// Head injury measures of every person whose head was struck, and the peak accelerations of every person's parts, where the
/// contact law cannot give them.
std::vector<AbsentMetric> absent_metrics(const Model&, const Recording&);

}  // namespace engine
