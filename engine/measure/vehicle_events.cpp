#include "engine/measure/vehicle_events.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace engine {
namespace {

bool strikes_vehicle(const Impact& impact, int vehicle) {
  return impact.a.party.vehicle == vehicle || impact.b.party.vehicle == vehicle;
}

/// [N s] in the plane of the road, as delta-v: what lies on a vehicle presses it down for long.
double level_push(const Impact& impact) {
  return impact.impulse.head<2>().norm();
}

/// When a stretch begins: its first push may be as old as the snapshot before.
double begin_of(const Recording& recording, const Stretch& span) {
  return recording.snapshots[span.first > 0 ? span.first - 1 : 0].time;
}

/// Time [s] from an exchange at an instant to the next one of two that still push on.
double until_next(const Model& model, const ContactRecord& c) {
  for (const ImpactSettings& s : model.impacts)
    if (std::minmax(s.body_a, s.body_b) == std::minmax(c.body_a, c.body_b) && s.penetration_time > 0) return s.penetration_time;
  return ImpactSettings{}.penetration_time;
}

/// A vehicle's exchanges with one partner each that change its velocity as a collision does, as long as they follow by the time
/// between them and the window: one push, of which the later exchanges may be too weak for phases.
std::vector<Stretch> exchanges_of(const Model& model, const Recording& recording, int vehicle) {
  const Party party = party_of(model, model.vehicles[vehicle].body);
  std::map<std::pair<int, int>, Stretch> current;
  std::vector<Stretch> out;
  for (std::size_t i = 0; i < recording.snapshots.size(); ++i)
    for (const ContactRecord& c : recording.snapshots[i].contacts) {
      if (!c.exchange || push_on(party, c).isZero(0) || changes_within_window(model, recording, party, i) <= kChange) continue;
      Stretch& span = current.try_emplace(std::minmax(c.body_a, c.body_b), Stretch{i, i}).first->second;
      const double apart = recording.snapshots[i].time - recording.snapshots[span.last].time;  // [s]
      if (apart > kWindow + until_next(model, c) + 1e-9) {
        out.push_back(span);
        span.first = i;
      }
      span.last = i;
    }
  for (const auto& [pair, span] : current) out.push_back(span);
  return out;
}

/// A phase of the vehicle, and those of it that overlap or follow within the window, one by one; exchanges that follow too.
Stretch event_of(const Model& model, const Recording& recording, const std::vector<Impact>& impacts, int vehicle,
                 const Impact& of) {
  const auto end = [&](const Stretch& span) { return recording.snapshots[span.last].time; };
  std::vector<Stretch> parts = exchanges_of(model, recording, vehicle);
  for (const Impact& i : impacts)
    if (strikes_vehicle(i, vehicle)) parts.push_back(i.span);
  Stretch event = of.span;
  for (bool grown = true; grown;) {
    grown = false;
    for (const Stretch& span : parts) {
      const double apart = std::max(begin_of(recording, span) - end(event), begin_of(recording, event) - end(span));  // [s]
      if (apart > kWindow + 1e-9) continue;
      const Stretch both{std::min(event.first, span.first), std::max(event.last, span.last)};
      grown = grown || both.first < event.first || both.last > event.last;
      event = both;
    }
  }
  return event;
}

/// The 250 ms at most of an event over which collisions change a party's velocity most: its maximum delta-v. Who is struck from
/// both sides has one of the two, and not their difference.
Stretch largest_change(const Model& model, const Recording& recording, const Party& party, const Stretch& event) {
  std::vector<Vec3> sum{Vec3::Zero()};  // [m/s] of the event up to each of its snapshots
  for (std::size_t i = event.first; i <= event.last; ++i)
    sum.push_back(sum.back() + side_of(model, recording, party, {i, i}).delta_v);
  Stretch most = event;
  double change = -1;
  for (std::size_t first = event.first; first <= event.last; ++first)
    for (std::size_t last = first; last <= event.last; ++last) {
      const Stretch part{first, last};
      if (last > first && recording.snapshots[last].time - begin_of(recording, part) > kLongest + 1e-9) break;
      const double by = (sum[last + 1 - event.first] - sum[first - event.first]).norm();
      if (by > change + 1e-9) change = by, most = part;
    }
  return most;
}

/// What the event around a phase of a vehicle did to a party: itself, or what is coupled to it.
ImpactSide side_in_event(const Model& model, const Recording& recording, const std::vector<Impact>& impacts, int vehicle,
                         const Impact& hardest, const Party& party) {
  const Stretch event = event_of(model, recording, impacts, vehicle, hardest);
  const Stretch part = largest_change(model, recording, party, event);
  ImpactSide side = side_of(model, recording, party, part);
  side.phases = 0;
  double squares = 0;  // energies add: E = m EES^2 / 2
  for (const Impact& i : impacts) {
    if (!strikes_vehicle(i, vehicle) || i.span.first > part.last || i.span.last < part.first) continue;
    ++side.phases;
    const double ees = (i.a.party.vehicle == vehicle ? i.a : i.b).ees;
    if (!std::isnan(ees)) squares += ees * ees;
  }
  side.ees = std::sqrt(squares);
  return side;
}

}  // namespace

const Impact* hardest_impact(const Model& model, const std::vector<Impact>& impacts, int vehicle) {
  const auto hardness = [&](const Impact& i) {
    return std::pair(!jointed(model, i.a.party.bodies.front(), i.b.party.bodies.front()), level_push(i));
  };
  const Impact* out = nullptr;
  for (const Impact& i : impacts)
    if (strikes_vehicle(i, vehicle) && (!out || hardness(i) > hardness(*out))) out = &i;
  return out;
}

std::optional<ImpactSide> hardest_event(const Model& model, const Recording& recording, const std::vector<Impact>& impacts,
                                        int vehicle) {
  const Party party = party_of(model, model.vehicles[vehicle].body);
  if (const Impact* hardest = hardest_impact(model, impacts, vehicle)) {
    ImpactSide out = side_in_event(model, recording, impacts, vehicle, *hardest, party);
    if (std::isnan((hardest->a.party.vehicle == vehicle ? hardest->a : hardest->b).ees)) out.ees = kUnknown;
    return out;
  }
  const Impact* hardest = nullptr;
  int struck = -1;
  for (int other = 0; other < static_cast<int>(model.vehicles.size()); ++other) {
    if (other == vehicle || !jointed(model, party.bodies.front(), model.vehicles[other].body)) continue;
    const Impact* of = hardest_impact(model, impacts, other);
    if (of && (!hardest || level_push(*of) > level_push(*hardest))) hardest = of, struck = other;
  }
  if (!hardest) return std::nullopt;
  ImpactSide out = side_in_event(model, recording, impacts, struck, *hardest, party);
  out.ees = kUnknown;
  return out;
}

}  // namespace engine
