// What a study asks of a run: its measures, how right it is, and which contacts it had in which order.
#pragma once

#include <string>
#include <vector>

#include "engine/measure/metrics.h"
#include "engine/model/model.h"
#include "engine/recording.h"

namespace cli::study {

struct Quantity {
  std::string name;     // "throw_distance_m", "delta_v_mps red": key of summary.json, and whose, where several may have it
  double value = 0;     // in the unit of its name
  bool so_far = false;  // a way to rest of who does not rest yet (cli/output/notices.h)
};

/// Measures first, then joint_gap_m and energy_residual_J, which are 0 in a perfect run.
std::vector<Quantity> quantities_of(const engine::Model&, const engine::Recording&);
/// The same from measures that are there already.
std::vector<Quantity> quantities_of(const engine::Model&, const engine::Recording&, const std::vector<engine::Metric>&);

/// True for the quantities whose right value is 0.
bool is_defect(const std::string& quantity);
/// How far from `value` the quantity can be at all: an angle of 0 to 180 degrees, or a direction; infinite for all others.
double widest_error(const std::string& quantity, double value);
/// Whether a screen or page with little room shows it; a quantity that is no measure always is.
bool is_on_screen(const std::string& quantity);

/// The unit a quantity's name ends in, "m" of "throw_distance_m"; empty without one.
std::string unit_of(const std::string& quantity);
/// The name in words, without unit: "throw distance", "delta v red".
std::string words_of(const std::string& quantity);

/// First touches in order of time, "pedestrian/left_leg+car": all contacts but those within one person and of tyres.
std::vector<std::string> contact_sequence(const engine::Recording&);

}  // namespace cli::study
