// What is quoted of a vehicle that rolls over: quarter turns, distance and mean drag factor from the trip to rest. And how the
// bodywork came down on the ground, of any vehicle.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "engine/math/functions.h"
#include "engine/measure/impacts.h"
#include "engine/measure/metrics.h"
#include "engine/measure/parties.h"

namespace engine {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;  // [rad]

/// Does it stand on wheels of both sides?
bool stands(const Snapshot& s, const Vehicle& vehicle, int v) {
  const auto side = [&](double sign) {
    return std::any_of(s.wheels.begin(), s.wheels.end(), [&](const WheelRecord& w) {
      return w.vehicle == v && w.load > 0 && sign * vehicle.wheels[static_cast<std::size_t>(w.wheel)].hub_B.y() > 0;
    });
  };
  return side(1) && side(-1);
}

/// Did it strike a vehicle or an object meanwhile? What that took of its speed is no drag.
bool struck_something(const std::vector<Impact>& impacts, int v, double from, double to) {
  return std::any_of(impacts.begin(), impacts.end(), [&](const Impact& i) {
    const bool its_own = (i.a.party.vehicle == v && i.b.party.person < 0) || (i.b.party.vehicle == v && i.a.party.person < 0);
    return its_own && i.time + i.duration >= from && i.time <= to;
  });
}

/// One time the bodywork came down.
struct Strike {
  double time = 0;               // [s]
  Vec3 impulse = Vec3::Zero();   // [N s] on the vehicle
  ContactRecord hardest;         // of its contacts
  const Snapshot* at = nullptr;  // of that
};

bool is_strike(const Party& party, const ContactRecord& c) {
  return c.body_b < 0 && holds(party, c.body_a) && !c.impulse.isZero(0);
}

/// What of the ground's push since the snapshot before is no weight that it bears meanwhile [N s].
Vec3 beyond_weight(const Model& model, const Recording& recording, const Party& party, std::size_t i) {
  Vec3 sum = Vec3::Zero();
  for (const ContactRecord& c : recording.snapshots[i].contacts)
    if (is_strike(party, c)) sum += c.impulse;
  if (i == 0 || sum.isZero(0)) return sum;
  const double length = recording.snapshots[i].time - recording.snapshots[i - 1].time;
  const Vec3 weight = mass_of(model, party) * length * model.settings.gravity, up = -weight.normalized();
  return sum - std::clamp(sum.dot(up), 0.0, weight.norm()) * up;
}

Strike strike_of(const Model& model, const Recording& recording, const Party& party, const Stretch& span) {
  const auto& all = recording.snapshots;
  Strike out;
  out.time = all[span.first].time;
  for (std::size_t i = span.first; i <= span.last; ++i) {
    out.impulse += beyond_weight(model, recording, party, i);
    for (const ContactRecord& c : all[i].contacts) {
      if (!is_strike(party, c)) continue;
      if (i == span.first) out.time = std::min(out.time, std::max(c.begun, all[i > 0 ? i - 1 : 0].time));
      if (!out.at || c.normal_impulse > out.hardest.normal_impulse) out.hardest = c, out.at = &all[i];
    }
  }
  return out;
}

/// Scraping along is none: what is exchanged has to make a collision, as in the table of impacts.
std::vector<Strike> ground_strikes(const Model& model, const Recording& recording, const Party& party, double from, double to) {
  std::vector<Vec3> push;
  for (std::size_t i = 0; i < recording.snapshots.size(); ++i) {
    const double time = recording.snapshots[i].time;
    push.push_back(time >= from && time <= to ? beyond_weight(model, recording, party, i) : Vec3(Vec3::Zero()));
  }
  const double bound = kChange * mass_of(model, party);
  std::vector<Strike> out;
  for (const Stretch& span : stretches(recording, push, bound))
    if (const Strike strike = strike_of(model, recording, party, span); strike.impulse.norm() > bound) out.push_back(strike);
  return out;
}

void measure_strikes(const Model& model, const Vehicle& vehicle, const std::vector<Strike>& strikes, std::vector<Metric>& out) {
  out.push_back({"ground_strikes", vehicle.name, static_cast<double>(strikes.size())});
  const auto hardest = std::max_element(strikes.begin(), strikes.end(),
                                        [](const Strike& a, const Strike& b) { return a.impulse.norm() < b.impulse.norm(); });
  if (hardest == strikes.end()) return;
  out.push_back({"ground_strike_s", vehicle.name, hardest->time});
  const Body& body = model.bodies[static_cast<std::size_t>(vehicle.body)];
  out.push_back({"ground_strike_mps", vehicle.name, hardest->impulse.norm() / mass_of(model, party_of(model, vehicle.body))});
  const auto* shape = std::get_if<MeshShape>(&body.shape);
  if (!shape || !shape->panels || hardest->hardest.body_a != vehicle.body) return;
  const Pose X_MW = (hardest->at->bodies[static_cast<std::size_t>(vehicle.body)].X_WB * shape->X_BM).inverse();
  const Panel panel =
      panel_at(*shape->mesh, *shape->panels, X_MW * hardest->hardest.point, X_MW.q * Vec3(-hardest->hardest.normal));
  if (panel != Panel::unknown) out.push_back({"ground_strike_panel", vehicle.name, 0, name_of(panel)});
}

/// Adds up how far a body has turned about its long axis: the way of the vertical in its cross plane.
class Roll {
 public:
  /// After the next attitude; none of it while the vehicle stands on nose or tail, where the vertical tells no roll.
  double after(const Quat& q_WB) {
    constexpr double kUpright = 0.3;  // [-] share of the vertical along the cross plane: 73 degrees of pitch
    const Vec3 up_B = q_WB.conjugate() * Vec3::UnitZ();
    if (math::hypot(up_B.y(), up_B.z()) < kUpright) {
      last_.reset();  // end over end it comes out upside down, and has not rolled
      return turned_;
    }
    const double lean = math::atan2(up_B.y(), up_B.z());
    if (last_) turned_ += std::remainder(lean - *last_, 4 * kQuarter);
    last_ = lean;
    return turned_;
  }

 private:
  std::optional<double> last_;  // [rad]
  double turned_ = 0;           // [rad]
};

}  // namespace

void measure_rollover(const Model& model, const Recording& recording, const std::vector<Impact>& impacts, int v,
                      std::vector<Metric>& out) {
  const Vehicle& vehicle = model.vehicles[static_cast<std::size_t>(v)];
  if (!has_track(vehicle)) return;
  const Party party = party_of(model, vehicle.body);
  const auto rest = rest_of(model, recording, party);
  const double end = rest.value_or(recording.end_time());
  Roll roll;
  const Snapshot* trip = &recording.snapshots.front();
  const Snapshot* upright = nullptr;            // from which on it stands on its wheels
  double turned = 0, way = 0, way_upright = 0;  // [rad], [m] from the trip
  bool tripped = false;
  Vec3 last = centre_of_mass(model, party, *trip);
  for (const Snapshot& s : recording.snapshots) {
    if (s.time > end) break;
    turned = roll.after(s.bodies[static_cast<std::size_t>(vehicle.body)].X_WB.q);
    tripped = tripped || std::abs(turned) > 0.5 * kQuarter;
    const Vec3 now = centre_of_mass(model, party, s);
    way += (now - last).head<2>().norm();
    last = now;
    const bool standing = stands(s, vehicle, v);
    if (!tripped && standing) trip = &s, way = 0;
    if (!standing) upright = nullptr;
    if (tripped && standing && !upright) upright = &s, way_upright = way;
  }
  const double quarters = std::round(std::abs(turned) / kQuarter);
  if (quarters < 1) {
    // it fell, or came down on its nose
    const std::vector<Strike> strikes = ground_strikes(model, recording, party, 0, end);
    if (!strikes.empty()) measure_strikes(model, vehicle, strikes, out);
    return;
  }
  out.push_back({"quarter_turns", vehicle.name, quarters});
  out.push_back({"trip_s", vehicle.name, trip->time});
  if (upright) way = way_upright;
  out.push_back({"roll_distance_m", vehicle.name, way});
  measure_strikes(model, vehicle, ground_strikes(model, recording, party, trip->time, end), out);
  const auto square = [&](const Snapshot& s) { return velocity_of(model, party, s).head<2>().squaredNorm(); };
  const double g = model.settings.gravity.norm();
  const auto ground = [&](const Snapshot& s) {
    Vec3 place = centre_of_mass(model, party, s);
    place.z() = model.ground.height_below(place).value_or(0);
    return place;
  };
  // down a bank, or on ground that is tilted as a whole, gravity gives what the ground takes
  const double given = model.settings.gravity.dot(ground(upright ? *upright : recording.at(end)) - ground(*trip));
  const double lost = square(*trip) - (upright ? square(*upright) : 0) + 2 * given;
  const bool struck = struck_something(impacts, v, trip->time, upright ? upright->time : end);
  if ((rest || upright) && way > 0 && g > 0 && !struck) out.push_back({"roll_drag_factor", vehicle.name, lost / (2 * g * way)});
}

}  // namespace engine
