#include "cli/study/quantities.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "cli/output/csv.h"
#include "cli/output/notices.h"
#include "engine/measure/definitions.h"

namespace cli::study {
namespace {

constexpr const char* kDefects[] = {"joint_gap_m", "energy_residual_J"};

/// Where the unit begins in a key, npos without one.
std::size_t unit_begin(const std::string& key) {
  const std::size_t underscore = key.rfind('_');
  if (underscore == std::string::npos) return underscore;
  constexpr const char* kUnits[] = {"m", "s", "mps", "deg", "g", "J", "N"};
  const std::string tail = key.substr(underscore + 1);
  return std::find(std::begin(kUnits), std::end(kUnits), tail) != std::end(kUnits) ? underscore : std::string::npos;
}

std::string key_of(const std::string& quantity) {
  return quantity.substr(0, quantity.find(' '));
}

}  // namespace

std::vector<Quantity> quantities_of(const engine::Model& model, const engine::Recording& recording) {
  return quantities_of(model, recording, engine::measure(model, recording));
}

std::vector<Quantity> quantities_of(const engine::Model& model, const engine::Recording& recording,
                                    const std::vector<engine::Metric>& metrics) {
  std::vector<Quantity> out;
  const std::vector<engine::AbsentMetric> absent = engine::absent_metrics(model, recording, metrics);
  const auto owners = model.persons.size() + model.vehicles.size() + model.bodies.size();
  for (const engine::Metric& metric : metrics) {
    if (!metric.text.empty()) continue;  // a word has no error
    const auto anothers = [&metric](const auto& other) { return other.key == metric.key && other.object != metric.object; };
    // in every run the same name: of two, one may not come to rest in some
    const bool alone = owners == 1 || (std::none_of(metrics.begin(), metrics.end(), anothers) &&
                                       std::none_of(absent.begin(), absent.end(), anothers));
    out.push_back({alone ? metric.key : metric.key + " " + metric.object, metric.value, is_so_far(metric, metrics, absent)});
  }
  if (!model.joints.empty()) out.push_back({"joint_gap_m", recording.diagnostics.max_joint_gap});
  out.push_back({"energy_residual_J", std::abs(recording.snapshots.back().energies.residual)});
  return out;
}

bool is_defect(const std::string& quantity) {
  return std::find(std::begin(kDefects), std::end(kDefects), quantity) != std::end(kDefects);
}

double widest_error(const std::string& quantity, double value) {
  if (key_of(quantity) == "turned_deg") return std::max(value, 180 - value);
  const bool direction = engine::turned_to(quantity, 270, 0) < 0;
  return direction ? 180 : std::numeric_limits<double>::infinity();
}

bool is_on_screen(const std::string& quantity) {
  const engine::Definition* known = engine::definition_of(key_of(quantity));
  return !known || known->main;
}

std::string unit_of(const std::string& quantity) {
  const std::string key = key_of(quantity);
  const std::size_t begin = unit_begin(key);
  if (begin == std::string::npos) return "";
  const std::string unit = key.substr(begin + 1);
  return unit == "mps" ? "m/s" : unit;
}

std::string words_of(const std::string& quantity) {
  const std::string key = key_of(quantity);
  std::string words = key.substr(0, unit_begin(key)) + quantity.substr(key.size());
  std::replace(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(std::min(words.size(), key.size())), '_', ' ');
  return words;
}

std::vector<std::string> contact_sequence(const engine::Recording& recording) {
  std::vector<std::string> out;
  std::set<std::pair<int, int>> seen;
  for (const engine::Snapshot& snapshot : recording.snapshots) {
    std::vector<std::string> now;
    for (const engine::ContactRecord& c : snapshot.contacts) {
      if (c.shapes.one_person || c.shapes.b == engine::ShapeKind::terrain || !(c.normal_impulse > 0)) continue;
      if (!seen.insert({c.body_a, c.body_b}).second) continue;
      now.push_back(body_name(recording, c.body_a) + "+" + body_name(recording, c.body_b));
    }
    // within one recorded instant no order is known
    std::sort(now.begin(), now.end());
    out.insert(out.end(), now.begin(), now.end());
  }
  return out;
}

}  // namespace cli::study
