#include <algorithm>
#include <cmath>

#include "engine/math/functions.h"
#include "engine/measure/metrics.h"

namespace engine {
namespace {

/// The last snapshot that cannot know of the exchange at `time`: what is recorded at the instant itself may already be its outcome.
const Snapshot& before(const Recording& recording, double time) {
  const auto at = std::lower_bound(recording.snapshots.begin(), recording.snapshots.end(), time,
                                   [](const Snapshot& s, double t) { return s.time < t; });
  return at == recording.snapshots.begin() ? *at : *(at - 1);
}

/// Velocity of the centre of the head seen from the vehicle's surface at the place of impact, world axes.
Vec3 approach(const Snapshot& s, const Event& impact) {
  Vec3 v = s.bodies[impact.body_a].V_WB.v;
  if (impact.body_b < 0) return v;
  const BodyState& struck = s.bodies[impact.body_b];
  // the point is that of the impact: the surface carried on to it while the snapshot waited
  const Vec3 arm = impact.point - (struck.X_WB.p + (impact.time - s.time) * struck.V_WB.v);
  return v - (struck.V_WB.v + struck.V_WB.w.cross(arm));
}

}  // namespace

namespace {

/// HIC and 3 ms clip of what the head went through from its first impact on: landing on the road counts too.
void measure_injury(const Person& person, const HeadMotion& head, double from, std::vector<Metric>& out) {
  std::vector<double> t, a;
  for (std::size_t i = 0; i < head.time.size(); ++i) {
    if (head.time[i] < from - 0.005) continue;
    t.push_back(head.time[i]);
    a.push_back(head.acceleration[i] / kGravity);
  }
  if (t.size() < 2) return;
  out.push_back({"hic15", person.name, hic(t, a, 0.015)});
  out.push_back({"hic36", person.name, hic(t, a, 0.036)});
  out.push_back({"three_ms_g", person.name, three_ms_clip(t, a)});
}

}  // namespace

void measure_head(const Model& model, const Recording& recording, int p, std::vector<Metric>& out) {
  const Person& person = model.persons[p];
  for (const Event& e : recording.events) {
    if (e.kind != "head_impact" || e.body_a != person.head) continue;
    out.push_back({"head_impact_s", person.name, e.time});
    const Vec3 v = approach(before(recording, e.time), e);
    out.push_back({"head_impact_speed_mps", person.name, v.norm()});
    for (const HeadMotion& head : recording.heads)
      if (head.person == p) measure_injury(person, head, e.time, out);
    if (e.body_b < 0) return;
    const Pose X_WB = recording.at(e.time).bodies[e.body_b].X_WB;
    // a tape from the front has a meaning only for a vehicle whose front runs against the person
    const bool forwards = (X_WB.q.conjugate() * v).x() < 0;
    const auto tape = wrap_around_distance(model, e.body_b, X_WB.inverse() * e.point);
    if (forwards && tape) out.push_back({"wrap_around_distance_m", person.name, *tape});
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
      if (mean > 0) best = std::max(best, span * math::pow(mean, 2.5));
    }
  return best;
}

double three_ms_clip(const std::vector<double>& t, const std::vector<double>& a) {
  constexpr double kHeld = 3e-3;  // [s]
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
  return "Default-Auto exchanges impulses in an instant: there is no acceleration to integrate or to have a peak";
}

std::vector<AbsentMetric> absent_metrics(const Model& model, const Recording& recording) {
  std::vector<AbsentMetric> out;
  const std::string reason = why_no_head_injury(model);
  if (reason.empty()) return out;
  for (const Person& person : model.persons) {
    const auto happened = [&](const Event& e, const char* kind) {
      return e.kind == kind && std::find(person.bodies.begin(), person.bodies.end(), e.body_a) != person.bodies.end();
    };
    const auto any = [&](const char* kind) {
      return std::any_of(recording.events.begin(), recording.events.end(), [&](const Event& e) { return happened(e, kind); });
    };
    if (any("head_impact"))
      for (const char* key : {"hic15", "hic36", "three_ms_g"}) out.push_back({key, person.name, reason});
    if (any("first_contact") || any("head_impact") || any("ground_contact"))
      out.push_back({"peak_acceleration_mps2", person.name, reason});
  }
  return out;
}

}  // namespace engine
