// Head injury criteria, of the whole course and of what the head did against each partner.
#include <algorithm>
#include <cmath>
#include <map>

#include "engine/measure/metrics.h"
#include "engine/measure/parties.h"

namespace engine {

double hic(const std::vector<double>& t, const std::vector<double>& a, double window) {
  std::vector<double> sum(t.size(), 0);
  for (std::size_t i = 1; i < t.size(); ++i) sum[i] = sum[i - 1] + a[i] * (t[i] - t[i - 1]);
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
  constexpr double kHeld = 3e-3 * (1 - 1e-9);  // [s]
  double best = 0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    double least = a[i];
    for (std::size_t k = i; least > best; least = std::min(least, a[k])) {
      if (t[k] - t[i - 1] >= kHeld) best = least;
      if (++k == t.size()) break;
    }
  }
  return best;
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

/// Which kind pushed the head hardest since the snapshot before: what several did at once is that one's. What is fixed to the
/// ground counts as ground. object: what is thrown, dropped or carried, and other persons.
enum class Partner { none, vehicle, ground, object };

Partner partner_in(const Model& model, const Snapshot& s, int head) {
  double by_vehicle = 0, by_ground = 0, by_object = 0;
  for (const ContactRecord& c : s.contacts) {
    if (c.body_a != head && c.body_b != head) continue;
    const int other = c.body_a == head ? c.body_b : c.body_a;
    if (c.shapes.on_ground() || is_fixture(model, other))
      by_ground += c.normal_impulse;
    else if (c.shapes.on_vehicle())
      by_vehicle += c.normal_impulse;
    else if (model.bodies[other].person != model.bodies[head].person)
      by_object += c.normal_impulse;
  }
  if (std::max({by_vehicle, by_ground, by_object}) <= 0) return Partner::none;
  if (by_vehicle >= std::max(by_ground, by_object)) return Partner::vehicle;
  return by_ground >= by_object ? Partner::ground : Partner::object;
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
                            road = touches(model, recording, person.head, Partner::ground),
                            thing = touches(model, recording, person.head, Partner::object);
    double first = 1e300;
    for (const auto* spans : {&car, &road, &thing})
      if (!spans->empty()) first = std::min(first, spans->front().from);
    if (first == 1e300) return;
    const Criteria whole = criteria(head, {{first, 1e300}});
    out.push_back({"hic15", person.name, whole.hic15});
    out.push_back({"hic36", person.name, whole.hic36});
    out.push_back({"three_ms_g", person.name, whole.clip});
    const auto note = [&](const std::vector<Span>& spans, const char* hic15, const char* clip) {
      const Criteria of = criteria(head, spans);
      if (!of.any) return;
      out.push_back({hic15, person.name, of.hic15});
      out.push_back({clip, person.name, of.clip});
    };
    note(car, "hic15_vehicle", "three_ms_vehicle_g");
    note(road, "hic15_ground", "three_ms_ground_g");
    note(thing, "hic15_object", "three_ms_object_g");
  }
}

}  // namespace engine
