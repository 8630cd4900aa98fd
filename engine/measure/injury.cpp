// Head injury criteria, of the whole course and of what the head did against each partner.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "engine/measure/metrics.h"
#include "engine/measure/parties.h"

namespace engine {

HicWindow hic_window(const std::vector<double>& t, const std::vector<double>& a, double window) {
  std::vector<double> sum(t.size(), 0);
  for (std::size_t i = 1; i < t.size(); ++i) sum[i] = sum[i - 1] + a[i] * (t[i] - t[i - 1]);
  HicWindow best;
  for (std::size_t i = 0; i < t.size(); ++i)
    for (std::size_t k = i + 1; k < t.size() && t[k] - t[i] <= window * (1 + 1e-9); ++k) {
      const double span = t[k] - t[i];
      const double mean = (sum[k] - sum[i]) / span;
      if (mean <= 0) continue;
      const double value = span * mean * mean * std::sqrt(mean);  // mean^2.5, without the powers of any exponent
      if (value > best.value) best = {value, t[i], t[k]};
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
/// ground counts as ground. object: what is thrown, dropped or carried, and other persons. wheel: its tyre is rigid and the damper
/// of its strut as hard as the head is fast, so that what it does to a head is no history of forces.
enum class Partner { none, vehicle, ground, object, wheel, count };

Partner partner_of(const Model& model, const ContactRecord& c, int head) {
  if (c.body_a != head && c.body_b != head) return Partner::none;
  const int other = c.body_a == head ? c.body_b : c.body_a;
  if (c.shapes.on_ground() || is_fixture(model, other)) return Partner::ground;
  if (c.shapes.on_vehicle()) return c.shapes.b == ShapeKind::tyre ? Partner::wheel : Partner::vehicle;
  return model.bodies[other].person != model.bodies[head].person ? Partner::object : Partner::none;
}

Partner partner_in(const Model& model, const Snapshot& s, int head) {
  std::array<double, static_cast<std::size_t>(Partner::count)> pushed{};  // [N s]
  for (const ContactRecord& c : s.contacts)
    if (const Partner partner = partner_of(model, c, head); partner != Partner::none)
      pushed[static_cast<std::size_t>(partner)] += c.normal_impulse;
  return static_cast<Partner>(std::max_element(pushed.begin(), pushed.end()) - pushed.begin());
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
  HicWindow hic15;
  double hic36 = 0, clip = 0;
  Span worst;  // of hic15
  bool any = false;
};

/// The worst of several stretches, each by itself.
Criteria criteria(const HeadMotion& head, const std::vector<Span>& spans) {
  Criteria out;
  for (const Span& span : spans) {
    const Course c = course_in(head, span);
    if (c.time.size() < 2) continue;
    out.any = true;
    if (const HicWindow of = hic_window(c.time, c.acceleration, 0.015); of.value > out.hic15.value)
      out.hic15 = of, out.worst = span;
    out.hic36 = std::max(out.hic36, hic(c.time, c.acceleration, 0.036));
    out.clip = std::max(out.clip, three_ms_clip(c.time, c.acceleration));
  }
  return out;
}

/// Who of one kind pushed the head hardest in a stretch.
StruckAtWorst hardest_in(const Model& model, const Recording& recording, int head, Partner wanted, const Span& span) {
  std::map<int, double> pushed, upwards;  // [N s] by body
  for (const Snapshot& s : recording.snapshots)
    for (const ContactRecord& c : s.contacts) {
      if (s.time <= span.from || s.time > span.to || partner_of(model, c, head) != wanted) continue;
      const int other = c.body_a == head ? c.body_b : c.body_a;
      pushed[other] += c.normal_impulse;
      upwards[other] += bears(c.normal) ? c.normal_impulse : 0;
    }
  const auto hardest =
      std::max_element(pushed.begin(), pushed.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  if (hardest == pushed.end()) return {};
  return {hardest->first, upwards[hardest->first] > 0.5 * hardest->second};
}

/// Without the stretches that others come within: a head pressed on the road by a wheel has no course of forces.
std::vector<Span> clear_of(std::vector<Span> spans, const std::vector<Span>& others) {
  std::erase_if(spans, [&](const Span& span) {
    return std::any_of(others.begin(), others.end(),
                       [&](const Span& o) { return o.from < span.to + kAround && span.from < o.to + kAround; });
  });
  return spans;
}

std::string name_of_party(const Model& model, int body) {
  if (body < 0) return "the road";
  const Party party = party_of(model, body);
  return party.person >= 0 ? model.persons[party.person].name : model.bodies[party.bodies.front()].name;
}

}  // namespace

bool wheel_met_head(const Model& model, const Recording& recording, int p) {
  const int head = model.persons[p].head;
  return std::any_of(recording.snapshots.begin(), recording.snapshots.end(), [&](const Snapshot& s) {
    return std::any_of(s.contacts.begin(), s.contacts.end(), [&](const ContactRecord& c) {
      return c.normal_impulse > 0 && partner_of(model, c, head) == Partner::wheel;
    });
  });
}

StruckAtWorst struck_at_worst(const Model& model, const Recording& recording, int p) {
  const int part = model.persons[p].head;
  for (const HeadMotion& head : recording.heads) {
    if (head.person != p) continue;
    const Criteria ground =
        criteria(head, clear_of(touches(model, recording, part, Partner::ground), touches(model, recording, part, Partner::wheel)));
    return hardest_in(model, recording, part, Partner::ground, ground.worst);
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
    if (!wheel_met_head(model, recording, p)) {
      const Criteria whole = criteria(head, {{first, 1e300}});
      out.push_back({"hic15", person.name, whole.hic15.value});
      out.push_back({"hic36", person.name, whole.hic36});
      out.push_back({"three_ms_g", person.name, whole.clip});
    }
    const auto note = [&](const std::vector<Span>& spans, Partner partner, const std::string& name) {
      const Criteria of = criteria(head, spans);
      if (!of.any) return;
      out.push_back({"hic15_" + name, person.name, of.hic15.value});
      out.push_back({"three_ms_" + name + "_g", person.name, of.clip});
      if (!(of.hic15.value > 0)) return;
      out.push_back({"hic15_" + name + "_s", person.name, of.hic15.from});
      const int by = hardest_in(model, recording, person.head, partner, of.worst).body;
      out.push_back({"hic15_" + name + "_by", person.name, 0, name_of_party(model, by)});
    };
    const std::vector<Span> wheel = touches(model, recording, person.head, Partner::wheel);
    note(clear_of(car, wheel), Partner::vehicle, "vehicle");
    note(clear_of(road, wheel), Partner::ground, "ground");
    note(clear_of(thing, wheel), Partner::object, "object");
  }
}

}  // namespace engine
