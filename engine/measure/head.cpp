#include <algorithm>
#include <cmath>

#include "engine/measure/metrics.h"

namespace engine {

void measure_head(const Model& model, const Recording& recording, int p, std::vector<Metric>& out) {
  const Person& person = model.persons[p];
  for (const Event& e : recording.events) {
    if (e.kind != "head_impact" || e.body_a != person.head) continue;
    out.push_back({"head_impact_s", person.name, e.time});
    // the snapshot before: the exchange itself takes no time
    const Snapshot before = recording.at(std::max(0.0, e.time - recording.interval));
    const BodyState& head = before.bodies[e.body_a];
    Vec3 v = head.V_WB.v + head.V_WB.w.cross(e.point - head.X_WB.p);
    if (e.body_b >= 0) v -= before.bodies[e.body_b].V_WB.v + before.bodies[e.body_b].V_WB.w.cross(e.point - before.bodies[e.body_b].X_WB.p);
    out.push_back({"head_impact_speed_mps", person.name, v.norm()});
    return;
  }
}

double hic(const std::vector<double>& t, const std::vector<double>& a, double window) {
  // integral by the trapezium rule, exact for a piecewise linear signal; then every pair of samples
  std::vector<double> sum(t.size(), 0);
  for (std::size_t i = 1; i < t.size(); ++i) sum[i] = sum[i - 1] + 0.5 * (a[i] + a[i - 1]) * (t[i] - t[i - 1]);
  double best = 0;
  for (std::size_t i = 0; i < t.size(); ++i)
    for (std::size_t k = i + 1; k < t.size() && t[k] - t[i] <= window * (1 + 1e-9); ++k) {
      const double span = t[k] - t[i];
      const double mean = (sum[k] - sum[i]) / span;
      if (mean > 0) best = std::max(best, span * std::pow(mean, 2.5));
    }
  return best;
}

double three_ms_clip(const std::vector<double>& t, const std::vector<double>& a) {
  constexpr double kHeld = 3e-3;   // [s]
  // longest stretch above a level, by bisection on the level
  auto longest_above = [&](double level) {
    double longest = 0, begin = 0;
    bool above = !a.empty() && a[0] >= level;
    if (above) begin = t[0];
    for (std::size_t i = 1; i < t.size(); ++i) {
      const bool now = a[i] >= level;
      const double crossing = now == above ? 0 : t[i - 1] + (level - a[i - 1]) / (a[i] - a[i - 1]) * (t[i] - t[i - 1]);
      if (now && !above) begin = crossing;
      if (!now && above) longest = std::max(longest, crossing - begin);
      above = now;
    }
    if (above && !t.empty()) longest = std::max(longest, t.back() - begin);
    return longest;
  };
  double low = 0, high = a.empty() ? 0 : *std::max_element(a.begin(), a.end());
  if (longest_above(low) < kHeld) return 0;
  for (int k = 0; k < 60; ++k) {
    const double level = 0.5 * (low + high);
    (longest_above(level) >= kHeld ? low : high) = level;
  }
  return low;
}

std::string why_no_head_injury(const Model& model) {
  if (model.settings.contact_law == ContactLaw::compliant) return "";
  return "Default-Auto exchanges impulses in an instant: an acceleration whose integral HIC takes does not exist";
}

}  // namespace engine
