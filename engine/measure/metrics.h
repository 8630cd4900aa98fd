// What a reconstructionist reads off a Recording. Keys are those of summary.json; a measure that the run does not define is absent.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/measure/impacts.h"
#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

struct Metric {
  std::string key;     // "throw_distance_m": the unit stands in the key
  std::string object;  // person, body or vehicle it belongs to
  double value = 0;    // SI
  std::string text{};  // of a measure that is a word, which has no value
};

/// A measure people ask for and this run cannot define, with the reason in a sentence.
struct AbsentMetric {
  std::string key;
  std::string object;
  std::string reason;
};

/// Everything below, for every object of the model.
std::vector<Metric> measure(const Model&, const Recording&);

/// Of a person, and of what it rides: throw, its phases (phases.h), rest. Of a person that no vehicle touched: way and fall.
void measure_throw(const Model&, const Recording&, int person, std::vector<Metric>&);

/// Of a person's head at its first impact on a vehicle: time; speed of the head's centre relative to the vehicle's surface at the
/// place of impact, as the event has it, with its parts along the surface's normal and across; place in the vehicle's own axes;
/// wrap-around distance, if the vehicle came with its front. And what the head suffers (measure_injury).
void measure_head(const Model&, const Recording&, int person, std::vector<Metric>&);

/// HIC and 3 ms clip from the head's first touch of a vehicle or the ground on; the same of its touches of vehicles alone and of
/// the ground alone, each from 5 ms before to 5 ms after, the worst touch. Only where the contact law gives accelerations.
void measure_injury(const Model&, const Recording&, int person, std::vector<Metric>&);

/// What the head met at the worst of the touches that hic15_ground is of.
struct StruckAtWorst {
  int body = -1;          // fixed, as a wall; -1: the ground itself, or nothing
  bool came_down = true;  // on it, as on the ground
};
StruckAtWorst struck_at_worst(const Model&, const Recording&, int person);

/// Whether a wheel met the head of a person: its tyre is rigid, and there are no head injury criteria of that.
bool wheel_met_head(const Model&, const Recording&, int person);

/// Of every part of a person: largest acceleration of its centre, mean over a step, free fall counting one g. Only with the
/// compliant law: a rigid impact changes velocities in an instant.
void measure_segments(const Model&, const Recording&, int person, std::vector<Metric>&);

/// Length [m] of a taut tape held in the vertical fore and aft plane through the head's impact `point_B` (body axes of the
/// vehicle), one end at the ground vertically below the foremost part, the other at the point, laid over the front and bonnet (Euro
/// NCAP, Pedestrian Testing Protocol 8.5, "wrap around distance"). The contour is the silhouette of the collision mesh within 0.15
/// m to either side; a taut tape bridges hollows. What lies higher than a point that is open to the front is not under the tape.
/// The ground is where the wheels stand at static load, as on a vehicle measured at rest. Absent if the body is no vehicle, has no
/// mesh there, or the point is open neither to the front nor upwards (underside, flank).
std::optional<double> wrap_around_distance(const Model&, int body, const Vec3& point_B);

/// Of free bodies: distance travelled and angle between the attitudes (0..180 deg) from start to end, time of rest, height of the
/// first rebound (of the body's lowest point above the ground).
void measure_body(const Model&, const Recording&, int body, std::vector<Metric>&);

/// Of a vehicle: length of its path, place and heading of rest, and of its hardest impact (impacts.h) delta_v_mps, pdof_deg (the
/// direction the force came from in the vehicle's axes just before: 0 from the front, positive from the right, 90 square on the
/// right side, 180 from behind) and ees_mps. The latter three are absent without an impact.
void measure_vehicle(const Model&, const Recording&, const std::vector<Impact>&, int vehicle, std::vector<Metric>&);

/// Of a vehicle that rolled onto its side or farther: quarter turns, the trip, and distance and mean drag factor from there to
/// rest.
void measure_rollover(const Model&, const Recording&, const std::vector<Impact>&, int vehicle, std::vector<Metric>&);

/// A head injury criterion, and where it has it.
struct HicWindow {
  double value = 0;
  double from = 0, to = 0;  // [s] of the window that gives it
};

/// Head injury criterion: max over windows of at most `window` [s] of (t2 - t1) (mean of a)^2.5. a [g] of an index is the mean over
/// the time since the one before, that of the first is not looked at: the integral is the change of speed. Windows begin and end at
/// the times given.
HicWindow hic_window(const std::vector<double>& times, const std::vector<double>& acceleration_g, double window);

inline double hic(const std::vector<double>& times, const std::vector<double>& acceleration_g, double window) {
  return hic_window(times, acceleration_g, window).value;
}

/// Largest level [g] that is held for 3 ms without a break, by the same means.
double three_ms_clip(const std::vector<double>& times, const std::vector<double>& acceleration_g);

/// Why head injury measures are absent, empty if they are there: rigid impacts exchange impulses in no time, an acceleration that
/// could be integrated does not exist.
std::string why_no_head_injury(const Model&);

/// Measures that people ask for and the run does not define, with the reason: in the order of the objects.
std::vector<AbsentMetric> absent_metrics(const Model&, const Recording&, const std::vector<Metric>& there);

}  // namespace engine
