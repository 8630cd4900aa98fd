// Head injury criteria, of the whole course and of what the head did against each partner.
#include <algorithm>
#include <cmath>
#include <map>

#include "engine/math/roots.h"
#include "engine/measure/metrics.h"
#include "engine/measure/parties.h"

namespace engine {

double hic(const std::vector<double>& t, const std::vector<double>& a, double window) {
  // integral by the trapezium rule, exact for a piecewise linear signal; then every pair of samples
  std::vector<double> sum(t.size(), 0);
  for (std::size_t i = 1; i < t.size(); ++i) sum[i] = sum[i - 1] + 0.5 * (a[i] + a[i - 1]) * (t[i] - t[i - 1]);
  double best = 0;
  for (std::size_t i = 0; i < t.size(); ++i)
    for (std::size_t k = i + 1; k < t.size() && t[k] - t[i] <= window * (1 + 1e-9); ++k) {
      const double span = t[k] - t[i];
      const double mean = (sum[k] - sum[i]) / span;
      if (mean > 0) best = std::max(best, span * mean * mean * std::sqrt(mean));  // mean^2.5, without the powers of any exponent
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
  if (longest_above(0) < kHeld) return 0;
  const double highest = a.empty() ? 0 : *std::max_element(a.begin(), a.end());
  return math::bisect({0, highest}, 60, 0, [&](double level) { return longest_above(level) >= kHeld; }).low;
}

namespace {

/// A stretch of the head's course, in g.
struct Course {
  std::vector<double> time, acceleration;
};

struct Span {
  double from = 0, to = 0;  // [s]
};

constexpr double kAround = 0.005;  // [s] kept before and after a touch: windows may begin and end where nothing acts

/// Which of two kinds pushed the head harder since the snapshot before: what both did at once is that one's. What is fixed to the
/// ground counts as ground.
enum class Partner { none, vehicle, ground };

Partner partner_in(const Model& model, const Snapshot& s, int head) {
  double by_vehicle = 0, by_ground = 0;
  for (const ContactRecord& c : s.contacts) {
    if (c.body_a != head) continue;
    if (c.shapes.on_ground() || is_fixture(model, c.body_b))
      by_ground += c.normal_impulse;
    else if (c.shapes.on_vehicle())
      by_vehicle += c.normal_impulse;
  }
  if (!(by_vehicle > 0) && !(by_ground > 0)) return Partner::none;
  return by_vehicle >= by_ground ? Partner::vehicle : Partner::ground;
}

/// Times at which the head is pushed by the partner wanted, neighbours run together. They reach not into the other's.
std::vector<Span> touches(const Model& model, const Recording& recording, int head, Partner wanted) {
  const auto& all = recording.snapshots;
  std::vector<Partner> partner;
  for (const Snapshot& s : all) partner.push_back(partner_in(model, s, head));
  const auto others = [&](std::size_t i) { return partner[i] != Partner::none && partner[i] != wanted; };
  std::vector<Span> out;
  double free_from = -1e300;  // [s] when the other's last push ended
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (others(i)) free_from = all[i].time;
    if (partner[i] != wanted) continue;
    const double from = std::max(all[i - 1].time - kAround, free_from);
    double to = all[i].time + kAround;
    for (std::size_t k = i + 1; k < all.size() && all[k - 1].time < to; ++k)
      if (others(k)) to = all[k - 1].time;
    if (!out.empty() && from <= out.back().to)
      out.back().to = to;
    else
      out.push_back({from, to});
  }
  return out;
}

Course course_in(const HeadMotion& head, const Span& span) {
  Course out;
  for (std::size_t i = 0; i < head.time.size(); ++i) {
    if (head.time[i] < span.from || head.time[i] > span.to) continue;
    out.time.push_back(head.time[i]);
    out.acceleration.push_back(head.acceleration[i] / kGravity);
  }
  return out;
}

struct Criteria {
  double hic15 = 0, hic36 = 0, clip = 0;
  bool any = false;
};

/// The worst of several stretches, each by itself.
Criteria criteria(const HeadMotion& head, const std::vector<Span>& spans) {
  Criteria out;
  for (const Span& span : spans) {
    const Course c = course_in(head, span);
    if (c.time.size() < 2) continue;
    out.any = true;
    out.hic15 = std::max(out.hic15, hic(c.time, c.acceleration, 0.015));
    out.hic36 = std::max(out.hic36, hic(c.time, c.acceleration, 0.036));
    out.clip = std::max(out.clip, three_ms_clip(c.time, c.acceleration));
  }
  return out;
}

}  // namespace

StruckAtWorst struck_at_worst(const Model& model, const Recording& recording, int p) {
  const int part = model.persons[p].head;
  for (const HeadMotion& head : recording.heads) {
    if (head.person != p) continue;
    Span worst;
    double most = 0;
    for (const Span& span : touches(model, recording, part, Partner::ground))
      if (const double hic15 = criteria(head, {span}).hic15; hic15 > most) most = hic15, worst = span;
    std::map<int, double> pushed, upwards;  // [N s] by body
    for (const Snapshot& s : recording.snapshots)
      for (const ContactRecord& c : s.contacts)
        if (c.body_a == part && s.time > worst.from && s.time <= worst.to && (c.shapes.on_ground() || is_fixture(model, c.body_b)))
          pushed[c.body_b] += c.normal_impulse, upwards[c.body_b] += bears(c.normal) ? c.normal_impulse : 0;
    const auto hardest =
        std::max_element(pushed.begin(), pushed.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    if (hardest != pushed.end()) return {hardest->first, upwards[hardest->first] > 0.5 * hardest->second};
  }
  return {};
}

void measure_injury(const Model& model, const Recording& recording, int p, std::vector<Metric>& out) {
  const Person& person = model.persons[p];
  for (const HeadMotion& head : recording.heads) {
    if (head.person != p) continue;
    const std::vector<Span> car = touches(model, recording, person.head, Partner::vehicle),
                            road = touches(model, recording, person.head, Partner::ground);
    if (car.empty() && road.empty()) return;
    const double first = std::min(car.empty() ? 1e300 : car.front().from, road.empty() ? 1e300 : road.front().from);
    const Criteria whole = criteria(head, {{first, 1e300}}), vehicle = criteria(head, car), ground = criteria(head, road);
    out.push_back({"hic15", person.name, whole.hic15});
    out.push_back({"hic36", person.name, whole.hic36});
    out.push_back({"three_ms_g", person.name, whole.clip});
    if (vehicle.any) {
      out.push_back({"hic15_vehicle", person.name, vehicle.hic15});
      out.push_back({"three_ms_vehicle_g", person.name, vehicle.clip});
    }
    if (ground.any) {
      out.push_back({"hic15_ground", person.name, ground.hic15});
      out.push_back({"three_ms_ground_g", person.name, ground.clip});
    }
  }
}

}  // namespace engine
