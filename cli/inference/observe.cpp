#include "cli/inference/observe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/measure/definitions.h"

namespace cli::inference {
namespace {

using engine::Model;
using engine::Recording;
using engine::Snapshot;
using engine::Vec3;
using scenes::Evidence;
using scenes::Seen;
using Prediction = std::optional<std::vector<double>>;

constexpr double kSpacing = 0.1;     // [m] between the points a mark is held against a trace by
constexpr double kWheelSlips = 0.5;  // [m/s] from there on a tyre marks the road
constexpr double kScuffs = 0.1;      // [m/s] the same of a body

bool is_named(const std::string& body, const std::string& name) {
  return body == name || (body.starts_with(name) && body.size() > name.size() && body[name.size()] == '/');
}

/// Indices of the bodies a name means; every person's, vehicle's and free body's where it is empty and there is only one of them.
std::vector<int> bodies_of(const Model& model, const std::string& name) {
  std::vector<int> out;
  if (name.empty() && model.persons.size() == 1) return model.persons[0].bodies;
  if (name.empty() && model.vehicles.size() == 1) return {model.vehicles[0].body};
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (name.empty() ? !model.bodies[b].fixed : is_named(model.bodies[b].name, name)) out.push_back(static_cast<int>(b));
  return out;
}

bool holds(const std::vector<int>& bodies, int body) {
  return std::find(bodies.begin(), bodies.end(), body) != bodies.end();
}

/// Of no person and no vehicle.
bool is_free(const Model& model, int body) {
  return std::none_of(model.persons.begin(), model.persons.end(), [&](const auto& p) { return holds(p.bodies, body); }) &&
         std::none_of(model.vehicles.begin(), model.vehicles.end(), [&](const auto& v) { return v.body == body; });
}

Vec3 centre(const Model& model, const std::vector<int>& bodies, const Snapshot& s) {
  Vec3 sum = Vec3::Zero();
  double mass = 0;
  for (const int b : bodies) {
    sum += model.bodies[b].mass * s.bodies[b].X_WB.p;
    mass += model.bodies[b].mass;
  }
  return sum / mass;
}

Prediction metric(const Evidence& e, const std::vector<engine::Metric>& metrics) {
  std::vector<double> found;
  for (const engine::Metric& m : metrics)
    if (m.key == e.metric && m.text.empty() && (e.of.empty() || m.object == e.of))
      found.push_back(engine::turned_to(m.key, m.value, e.value.front()));
  if (found.size() != 1) return std::nullopt;
  return found;
}

/// Where it first touched the ground: of persons and vehicles an event, of a free body the first touch that is recorded.
Prediction landing(const Evidence& e, const Model& model, const Recording& recording) {
  const std::vector<int> bodies = bodies_of(model, e.of);
  const auto place = [](const Vec3& p) { return std::vector<double>{p.x(), p.y()}; };
  for (const engine::Event& event : recording.events)
    if (event.kind == "ground_contact" && holds(bodies, event.body_a)) return place(event.point);
  const bool free = std::all_of(bodies.begin(), bodies.end(), [&](int b) { return is_free(model, b); });
  for (const Snapshot& s : recording.snapshots)
    for (const engine::ContactRecord& c : s.contacts)
      if (free && c.body_b < 0 && c.normal_impulse > 0 && holds(bodies, c.body_a)) return place(c.point);
  return std::nullopt;
}

struct Touch {
  const Snapshot* snapshot;
  const engine::ContactRecord* contact;
  int other;  // the body of `with`
};

std::optional<Touch> first_touch(const Evidence& e, const Model& model, const Recording& recording) {
  const std::vector<int> of = bodies_of(model, e.of), with = bodies_of(model, e.with);
  for (const Snapshot& s : recording.snapshots)
    for (const engine::ContactRecord& c : s.contacts) {
      if (!(c.normal_impulse > 0)) continue;
      if (holds(of, c.body_a) && holds(with, c.body_b)) return Touch{&s, &c, c.body_b};
      if (holds(of, c.body_b) && holds(with, c.body_a)) return Touch{&s, &c, c.body_a};
    }
  return std::nullopt;
}

Prediction contact_place(const Evidence& e, const Model& model, const Recording& recording) {
  const auto touch = first_touch(e, model, recording);
  if (!touch) return std::nullopt;
  const Vec3 p = touch->snapshot->bodies[static_cast<std::size_t>(touch->other)].X_WB.inverse() * touch->contact->point;
  return std::vector<double>{p.x(), p.y(), p.z()};
}

Prediction speed(const Evidence& e, const Model& model, const Recording& recording) {
  if (e.at > recording.end_time() + 1e-9) return std::vector<double>{0};  // it rests
  const std::vector<int> bodies = bodies_of(model, e.of);
  const Snapshot s = recording.at(e.at);
  Vec3 momentum = Vec3::Zero();
  double mass = 0;
  for (const int b : bodies) {
    momentum += model.bodies[b].mass * s.bodies[b].V_WB.v;
    mass += model.bodies[b].mass;
  }
  if (!(mass > 0)) return std::nullopt;
  return std::vector<double>{momentum.norm() / mass};
}

/// Where the run marks the ground: all of it, and what the wheels of the left and those of the right mark by themselves.
std::array<std::vector<Vec3>, 3> traces_of(const Evidence& e, const Model& model, const Recording& recording) {
  const std::vector<int> bodies = bodies_of(model, e.of);
  std::array<std::vector<Vec3>, 3> out;
  auto& [all, left, right] = out;
  for (const Snapshot& s : recording.snapshots) {
    for (const engine::WheelRecord& w : s.wheels) {
      const engine::Vehicle& vehicle = model.vehicles[static_cast<std::size_t>(w.vehicle)];
      if (!holds(bodies, vehicle.body) || w.slip <= kWheelSlips) continue;
      all.push_back(w.contact);
      (vehicle.wheels[static_cast<std::size_t>(w.wheel)].hub_B.y() > 0 ? left : right).push_back(w.contact);
    }
    for (const engine::ContactRecord& c : s.contacts)
      if (c.body_b < 0 && holds(bodies, c.body_a) && c.normal_impulse > 0 && c.slip > kScuffs) all.push_back(c.point);
  }
  return out;
}

double squared_distance(const Vec3& from, const std::vector<Vec3>& to) {
  double best = std::numeric_limits<double>::infinity();
  for (const Vec3& p : to) best = std::min(best, (p - from).head<2>().squaredNorm());
  return best;
}

double mean_square(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  double sum = 0;
  for (const Vec3& p : from) sum += squared_distance(p, to);
  return sum / static_cast<double>(from.size());
}

/// Both ways: what the run marks and was not seen counts as what was seen and the run does not mark. A line is one track: it is
/// held against that of one side too, and the nearest counts.
Prediction mark(const Evidence& e, const Model& model, const Recording& recording) {
  const auto traces = traces_of(e, model, recording);
  if (traces.front().empty()) return std::nullopt;
  std::vector<Vec3> seen;
  for (std::size_t i = 0; i + 1 < e.mark.size(); ++i) {
    const int pieces = std::max(1, static_cast<int>(std::ceil((e.mark[i + 1] - e.mark[i]).norm() / kSpacing)));
    for (int k = 0; k < pieces; ++k) seen.push_back(e.mark[i] + (e.mark[i + 1] - e.mark[i]) * k / pieces);
  }
  seen.push_back(e.mark.back());
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<Vec3>& trace : traces)
    if (!trace.empty()) least = std::min(least, 0.5 * (mean_square(seen, trace) + mean_square(trace, seen)));
  return std::vector<double>{std::sqrt(least)};
}

}  // namespace

Prediction observe(const Evidence& e, const Model& model, const Recording& recording, const std::vector<engine::Metric>& metrics) {
  switch (e.seen) {
    case Seen::metric:
      return metric(e, metrics);
    case Seen::rest_place: {
      const std::vector<int> bodies = bodies_of(model, e.of);
      if (bodies.empty()) return std::nullopt;
      const Vec3 p = centre(model, bodies, recording.snapshots.back());
      return std::vector<double>{p.x(), p.y()};
    }
    case Seen::landing_place:
      return landing(e, model, recording);
    case Seen::contact_place:
      return contact_place(e, model, recording);
    case Seen::speed:
      return speed(e, model, recording);
    case Seen::mark:
      return mark(e, model, recording);
    case Seen::contact:
    case Seen::no_contact:
      return std::vector<double>{first_touch(e, model, recording) ? 1.0 : 0.0};
  }
  return std::nullopt;
}

std::map<std::string, std::array<double, 2>> rest_places(const Model& model, const Recording& recording,
                                                         const std::vector<engine::Metric>& metrics) {
  constexpr double kWent = 1e-3;  // [m]
  std::map<std::string, std::array<double, 2>> out;
  const Snapshot &start = recording.snapshots.front(), &end = recording.snapshots.back();
  const auto add = [&](const std::string& name, const std::vector<int>& bodies) {
    const Vec3 p = centre(model, bodies, end);
    const bool came_to_rest =
        std::any_of(metrics.begin(), metrics.end(), [&](const engine::Metric& m) { return m.key == "rest_s" && m.object == name; });
    if (came_to_rest || (p - centre(model, bodies, start)).norm() < kWent) out[name] = {p.x(), p.y()};
  };
  for (const auto& person : model.persons) add(person.name, person.bodies);
  for (const auto& vehicle : model.vehicles) add(vehicle.name, {vehicle.body});
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (!model.bodies[b].fixed && is_free(model, static_cast<int>(b))) add(model.bodies[b].name, {static_cast<int>(b)});
  return out;
}

double misfit(const Evidence& e, const Prediction& predicted) {
  if (!predicted) return kMissing;
  if (e.seen == Seen::contact || e.seen == Seen::no_contact) return predicted->front() == e.value.front() ? 0 : kWrong;
  double sum = 0;
  for (std::size_t i = 0; i < e.value.size(); ++i) {
    const double off = ((*predicted)[i] - e.value[i]) / e.tolerance;
    sum += off * off;
  }
  return std::sqrt(sum);
}

}  // namespace cli::inference
