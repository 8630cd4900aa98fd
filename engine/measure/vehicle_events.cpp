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

/// What the event around a phase of a vehicle did to a party: itself, or what is coupled to it.
ImpactSide side_in_event(const Model& model, const Recording& recording, const std::vector<Impact>& impacts, int vehicle,
                         const Impact& hardest, const Party& party) {
  const Stretch event = event_of(model, recording, impacts, vehicle, hardest);
  std::optional<ImpactSide> most;
  for (std::size_t first = event.first; first <= hardest.span.first; ++first) {
    Stretch part{first, first};
    while (part.last < event.last && recording.snapshots[part.last + 1].time - begin_of(recording, part) <= kLongest + 1e-9)
      ++part.last;
    part.last = std::max(part.last, first == hardest.span.first ? hardest.span.last : first);
    if (part.last < hardest.span.last) continue;
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
    if (!most || side.delta_v.norm() > most->delta_v.norm()) most = std::move(side);
    if (part.last == event.last) break;  // the whole of it, or of its end
  }
  return *most;
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
