#include "engine/measure/impacts.h"
#include "engine/math/functions.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

namespace engine {
namespace {

constexpr double kShareOfMost = 0.1;  // [-] of a pair's strongest window, where none reaches the bound

/// Two parties that touch, named by the first body of each.
struct Pair {
  Party a, b;
};

bool has_vehicle(const Pair& pair) {
  return pair.a.vehicle >= 0 || pair.b.vehicle >= 0;
}

bool has_person(const Pair& pair) {
  return pair.a.person >= 0 || pair.b.person >= 0;
}

/// A vehicle and what it touches; a person and somebody else, or an object that is no fixture.
bool counts(const Model& model, const ContactRecord& c) {
  if (c.body_b < 0) return false;
  const Body &a = model.bodies[c.body_a], &b = model.bodies[c.body_b];
  if (a.vehicle >= 0 || b.vehicle >= 0) return c.shapes.with_vehicle();
  return a.person != b.person && !is_fixture(model, c.body_a) && !is_fixture(model, c.body_b);
}

bool between(const Pair& pair, const ContactRecord& c) {
  return (holds(pair.a, c.body_a) && holds(pair.b, c.body_b)) || (holds(pair.a, c.body_b) && holds(pair.b, c.body_a));
}

std::vector<Pair> pairs_of(const Model& model, const Recording& recording) {
  std::map<std::pair<int, int>, Pair> pairs;
  for (const Snapshot& s : recording.snapshots)
    for (const ContactRecord& c : s.contacts) {
      if (!counts(model, c) || c.impulse.isZero(0)) continue;
      Party a = party_of(model, c.body_a), b = party_of(model, c.body_b);
      // a vehicle before what it strikes, an object before a person; of two alike that of lower number
      const auto rank = [](const Party& party) {
        return std::pair(party.vehicle < 0 ? 1 + (party.person >= 0) : 0, party.bodies.front());
      };
      if (rank(b) < rank(a)) std::swap(a, b);
      pairs.try_emplace({a.bodies.front(), b.bodies.front()}, Pair{a, b});
    }
  std::vector<Pair> out;
  for (auto& [key, pair] : pairs) out.push_back(std::move(pair));
  return out;
}

/// Impulse [N s] on a since the snapshot before, per snapshot. A child in arms, or a bag in a hand, presses on who holds it and
/// strikes nobody before it is let go.
std::vector<Vec3> pushes(const Model& model, const Recording& recording, const Pair& pair) {
  const double held = has_vehicle(pair) ? -1 : joined_until(model, recording, pair.a, pair.b).value_or(-1);
  std::vector<Vec3> out;
  for (const Snapshot& s : recording.snapshots) {
    Vec3 sum = Vec3::Zero();
    for (const ContactRecord& c : s.contacts)
      if (s.time > held && between(pair, c)) sum += push_on(pair.a, c);
    out.push_back(sum);
  }
  return out;
}

/// Velocity [m/s] of the body's point at `p`.
Vec3 velocity_of_point(int b, const Snapshot& s, const Vec3& p) {
  const BodyState& body = s.bodies[b];
  return body.V_WB.v + body.V_WB.w.cross(p - body.X_WB.p);
}

/// Which of the contacts of a snapshot began first; null where none of the pair pushes.
const ContactRecord* earliest_of(const Pair& pair, const Snapshot& s) {
  const ContactRecord* earliest = nullptr;
  for (const ContactRecord& c : s.contacts)
    if (between(pair, c) && !c.impulse.isZero(0) && (!earliest || c.begun < earliest->begun)) earliest = &c;
  return earliest;
}

/// How fast [m/s] a person and what it meets close where they first touch, of the part that does. Over a phase in which somebody
/// wraps round a front the mean plane leans by half a right angle: nobody closes along that.
double first_closing(const Recording& recording, const Pair& pair, std::size_t touch) {
  const Snapshot &before = recording.snapshots[touch > 0 ? touch - 1 : 0], &first = recording.snapshots[touch];
  const ContactRecord* earliest = earliest_of(pair, first);
  if (!earliest) return kUnknown;
  // one value for one thing: the recorder saw that touch in its step
  for (const Event& e : recording.events)
    if (e.kind == "first_contact" && e.body_b == earliest->body_b && (holds(pair.a, e.body_a) || holds(pair.b, e.body_a)) &&
        e.time >= before.time && e.time <= first.time)
      return e.value;
  const Vec3& p = earliest->point;
  return -(velocity_of_point(earliest->body_a, before, p) - velocity_of_point(earliest->body_b, before, p)).dot(earliest->normal);
}

/// How fast [m/s] the parts that touch first go past or towards each other there.
double relative_speed_of(const Recording& recording, const Pair& pair, std::size_t touch, const Impact& impact) {
  const Snapshot &before = recording.snapshots[touch > 0 ? touch - 1 : 0], &first = recording.snapshots[touch];
  const ContactRecord* earliest = earliest_of(pair, first);
  if (!earliest) return kUnknown;
  const Vec3& p = has_person(pair) ? earliest->point : impact.point;
  return (velocity_of_point(earliest->body_a, before, p) - velocity_of_point(earliest->body_b, before, p)).norm();
}

/// Snapshot of the touch that leads to a pair's first phase: a hand or a foot may be met first, and too softly to count. Along with
/// the car since then, the part met next tells no closing speed any more.
std::size_t touch_of(const Recording& recording, const std::vector<Vec3>& push, std::size_t first) {
  const auto time = [&](std::size_t i) { return recording.snapshots[i].time; };
  std::size_t touch = first;
  for (std::size_t i = first; i-- > 0 && time(touch) - time(i) <= kWindow + 1e-9 && time(first) - time(i) <= kLongest;)
    if (!push[i].isZero(0)) touch = i;
  return touch;
}

/// One value for one thing: what an exchange at an instant told as its event.
std::optional<double> told_closing(const Recording& recording, const Impact& impact) {
  const auto bodies = std::minmax(impact.a.party.bodies.front(), impact.b.party.bodies.front());
  for (const Event& e : recording.events)
    if (e.kind == "impact" && std::minmax(e.body_a, e.body_b) == bodies && e.time == impact.time) return e.value;
  return std::nullopt;
}

/// Direction [deg] a level push came from, seen from a vehicle's heading. One that lies on its side or roof has no front, right and
/// left in the plane of the road.
double pdof_of(const Quat& q_WB, const Vec3& push) {
  constexpr double kUpright = 0.7;  // [-] leans by less than 45 degrees
  Vec3 ahead = q_WB * Vec3::UnitX();
  ahead.z() = 0;
  if (push.norm() < 1e-9 || (q_WB * Vec3::UnitZ()).z() < kUpright) return kUnknown;
  ahead.normalize();
  double left = push.dot(Vec3::UnitZ().cross(ahead));
  if (std::abs(left) < 1e-6 * push.norm()) left = 0;  // square from behind is 180 deg, not now and then -180
  return math::atan2(left, -push.dot(ahead)) * 180 / std::numbers::pi;
}

/// Mass [kg] of a vehicle with who rides it.
double mass_with_riders(const Model& model, const Party& party) {
  double mass = mass_of(model, party);
  for (const Person& person : model.persons) {
    const Party rider = party_of(model, person.bodies.front());
    const bool rides = std::any_of(model.joints.begin(), model.joints.end(), [&](const Joint& j) {
      return (holds(party, j.parent) && holds(rider, j.child)) || (holds(party, j.child) && holds(rider, j.parent));
    });
    if (rides) mass += mass_of(model, rider);
  }
  return mass;
}

/// What its tyres did to a vehicle's velocity [m/s]. Those of a bicycle carry six times its mass, and more where a bonnet presses
/// it down: of a two-wheeler's counts what they do under its weight and the rider's, to both.
Vec3 done_by_tyres(const Model& model, const Recording& recording, const Party& party, const Stretch& span) {
  Vec3 impulse = Vec3::Zero();
  for (std::size_t i = span.first; i <= span.last; ++i)
    if (const auto& of = recording.snapshots[i].tyre_impulse; party.vehicle < static_cast<int>(of.size()))
      impulse += of[party.vehicle];
  if (!is_two_wheeler(model, party)) return impulse / mass_of(model, party);
  const double duration = recording.snapshots[span.last].time - recording.snapshots[span.first > 0 ? span.first - 1 : 0].time;
  const double mass = mass_with_riders(model, party), weight = mass * model.settings.gravity.norm() * duration;
  return std::min(1.0, weight / std::max(impulse.z(), 1e-9)) * impulse / mass;
}

/// Against a kerb or another low thing that is fixed: well below the hubs there is no bodywork, only tyres, wheels and suspension.
/// A car's widest line may be at the height of its hubs.
bool below_hubs(const Model& model, const Snapshot& before, const Party& party, const Vec3& point) {
  if (party.vehicle < 0) return false;
  const auto& wheels = model.vehicles[party.vehicle].wheels;
  const double z = (before.bodies[party.bodies.front()].X_WB.inverse() * point).z();
  return !wheels.empty() &&
         std::all_of(wheels.begin(), wheels.end(), [&](const Wheel& w) { return z < w.hub_B.z() - 0.25 * w.radius; });
}

/// Does a joint hold something to the vehicle that moves: a trailer, what draws it, a rider?
bool is_coupled(const Model& model, const Party& party) {
  return std::any_of(model.joints.begin(), model.joints.end(), [&](const Joint& j) {
    return j.parent >= 0 && holds(party, j.parent) != holds(party, j.child) &&
           !model.bodies[holds(party, j.parent) ? j.child : j.parent].fixed;
  });
}

/// Why the energy of a phase tells no energy equivalent speed; empty: it does. `by_mass` where no stiffness tells how to share it.
const char* why_no_ees(const Model& model, const Snapshot& before, const Impact& impact, bool by_mass) {
  const Party &a = impact.a.party, &b = impact.b.party;
  if (has_person({a, b})) return "its hardest impact was with a person, who deforms no car";
  if (!(impact.energy_lost > 0)) return "its hardest impact cost no energy";
  if (by_mass && is_two_wheeler(model, a) != is_two_wheeler(model, b))
    return "its hardest impact was that of a two-wheeler and another vehicle, and the scene does not tell their stiffnesses apart: "
           "the rule "
           "of masses is that of cars";
  // a trailer of 300 kg before a car of 1500 kg would get nearly all of what stops both: more than it closed at
  if (by_mass && (is_coupled(model, a) || is_coupled(model, b)))
    return "what is coupled to one of the two pressed as well, and the scene does not tell their stiffnesses apart: the rule of "
           "masses is that of cars by themselves";
  const auto fixed = [&](const Party& party) { return model.bodies[party.bodies.front()].fixed; };
  // what a rider or a trailer gave through its holds is in the energy, and not in the mass
  if ((fixed(a) && is_coupled(model, b)) || (fixed(b) && is_coupled(model, a)))
    return "what is coupled to it pressed on what is fixed as well: the energy is not that of the one alone";
  // an energy equivalent speed is told from what bodywork crushes: that of wheels against a kerb has no such scale
  if ((fixed(a) && below_hubs(model, before, b, impact.point)) || (fixed(b) && below_hubs(model, before, a, impact.point)))
    return "its hardest impact was that of its wheels with something low, such as a kerb: no bodywork is crushed";
  return "";
}

/// The two are pressed together by the same force: each takes up energy as it gives way, in inverse proportion to stiffness. Where
/// nobody has told their stiffnesses apart they go with the masses, as crash tests of cars of all classes show on the whole.
void share_energy(const Model& model, const Snapshot& before, Impact& impact) {
  const Body &A = model.bodies[impact.a.party.bodies.front()], &B = model.bodies[impact.b.party.bodies.front()];
  const double S_a = A.surface.stiffness.at(impact.time), S_b = B.surface.stiffness.at(impact.time);
  const bool fixed = A.fixed || B.fixed, by_mass = !fixed && S_a == S_b;
  impact.no_ees = why_no_ees(model, before, impact, by_mass);
  if (*impact.no_ees) return;
  double of_a = by_mass ? B.mass / (A.mass + B.mass) : S_b / (S_a + S_b);
  if (fixed) of_a = A.fixed ? 0 : 1;
  impact.ees_rule = fixed ? "all to the one that moves" : by_mass ? "by mass" : "by stiffness";
  const auto speed = [&](double share, double mass) { return std::sqrt(2 * share * impact.energy_lost / mass); };
  if (impact.a.party.vehicle >= 0 && !A.fixed) impact.a.ees = speed(of_a, A.mass);
  if (impact.b.party.vehicle >= 0 && !B.fixed) impact.b.ees = speed(1 - of_a, B.mass);
}

/// Point, plane, impulse and energy from the contacts of the phase; returns when the first of them began.
double sum_contacts(const Recording& recording, const Pair& pair, const Stretch& span, Impact& out) {
  Vec3 place = Vec3::Zero(), normal = Vec3::Zero();
  double weight = 0, pressed = 0, used = 0, limit = 0, first = recording.snapshots[span.first].time;
  for (std::size_t i = span.first; i <= span.last; ++i)
    for (const ContactRecord& c : recording.snapshots[i].contacts) {
      if (!between(pair, c) || c.impulse.isZero(0)) continue;
      const double amount = c.impulse.norm();
      place += amount * c.point;
      weight += amount;
      normal += (holds(pair.a, c.body_a) ? 1 : -1) * c.normal_impulse * c.normal;
      out.impulse += push_on(pair.a, c);
      out.energy_lost += c.energy_lost;
      pressed += c.normal_impulse;
      used += c.tangential_impulse;
      limit += c.friction_limit;
      first = std::min(first, c.begun);
    }
  if (weight > 0) out.point = place / weight;
  if (pressed > 0) out.friction_used = used / pressed, out.friction_limit = limit / pressed;
  if (normal.norm() > 0) out.normal = normal.normalized();
  return std::max(first, span.first > 0 ? recording.snapshots[span.first - 1].time : 0.0);
}

const char* law_of(const Model& model, const Pair& pair, const ContactRecord& c) {
  const Body &A = model.bodies[c.body_a], &B = model.bodies[c.body_b];
  const bool meshes = c.shapes.between_vehicles();
  if (meshes && model_between(A.collision_model, B.collision_model) == CollisionModel::kudlich_slibar) return "kudlich_slibar";
  return yields(model.settings.contact_law, has_person(pair)) ? "compliant" : "default_auto";
}

/// To the end of the phase; exchanges at instants last from the first to the last of them.
double duration_of(const Recording& recording, const Pair& pair, const Stretch& span, double from) {
  double last = from;
  for (std::size_t i = span.first; i <= span.last; ++i)
    for (const ContactRecord& c : recording.snapshots[i].contacts) {
      if (!between(pair, c) || c.impulse.isZero(0)) continue;
      if (!c.exchange) return recording.snapshots[span.last].time - from;
      last = std::max(last, c.begun);
    }
  return last - from;
}

/// Velocity [m/s] that all who struck a person or an object gave it in a phase, walls too: a car presses who stands between it and
/// another with twice what both change. Not what bears it, nor what it holds. Of the road only what it takes of a push `along` it:
/// it holds who lies under a wheel.
Vec3 given_to(const Model& model, const Recording& recording, const Party& party, const Stretch& span, bool along) {
  std::map<int, double> held;  // [s] by the first body of who is joined to it
  Vec3 impulse = Vec3::Zero();
  for (std::size_t i = span.first; i <= span.last; ++i)
    for (const ContactRecord& c : recording.snapshots[i].contacts) {
      const bool first = holds(party, c.body_a);
      if (first == (c.body_b >= 0 && holds(party, c.body_b)) || c.impulse.isZero(0)) continue;
      if (c.body_b < 0) {
        if (along) impulse += c.impulse;
        continue;
      }
      const int other = first ? c.body_b : c.body_a;
      if (is_ground(model, c.shapes, other, first ? c.normal : Vec3(-c.normal))) {
        if (along && model.bodies[other].fixed) impulse += push_on(party, c);
        continue;
      }
      if (model.bodies[other].vehicle < 0) {
        const Party partner = party_of(model, other);
        const auto [known, is_new] = held.try_emplace(partner.bodies.front(), -1);
        if (is_new) known->second = joined_until(model, recording, party, partner).value_or(-1);
        if (recording.snapshots[i].time <= known->second) continue;
      }
      impulse += push_on(party, c);
    }
  return impulse / mass_of(model, party);
}

/// What the pair alone did to each; of a person or an object also what others did meanwhile.
void tell_shares(const Model& model, const Recording& recording, const Pair& pair, Impact& impact) {
  const auto tell = [&](ImpactSide& side, const Vec3& impulse) {
    if (model.bodies[side.party.bodies.front()].fixed) return;
    side.own_delta_v = impulse / mass_of(model, side.party);
    if (side.party.vehicle < 0) side.delta_v = given_to(model, recording, side.party, impact.span, has_vehicle(pair));
    // things fall on heads: without a vehicle there is no plane that the blow lies in
    if (has_vehicle(pair)) side.own_delta_v.z() = side.delta_v.z() = 0;
  };
  tell(impact.a, impact.impulse);
  tell(impact.b, -impact.impulse);
}

Impact impact_of(const Model& model, const Recording& recording, const Pair& pair, const Stretch& span, std::size_t touch) {
  Impact out;
  out.span = span;
  out.time = sum_contacts(recording, pair, span, out);
  if (out.energy_lost < 0) out.energy_lost = kUnknown;
  const Snapshot& before = recording.snapshots[span.first > 0 ? span.first - 1 : 0];
  out.duration = duration_of(recording, pair, span, out.time);
  out.a = side_of(model, recording, pair.a, span);
  out.b = side_of(model, recording, pair.b, span);
  tell_shares(model, recording, pair, out);
  if (const ContactRecord* first = earliest_of(pair, recording.snapshots[touch])) {
    out.a.part = holds(pair.a, first->body_a) ? first->body_a : first->body_b;
    out.b.part = holds(pair.a, first->body_a) ? first->body_b : first->body_a;
  }
  const auto at_point = [&](const Party& party) { return velocity_of_point(party.bodies.front(), before, out.point); };
  out.closing_speed =
      has_person(pair) ? first_closing(recording, pair, touch) : -(at_point(pair.a) - at_point(pair.b)).dot(out.normal);
  if (const auto told = told_closing(recording, out)) out.closing_speed = *told;
  // two that touch already and are pressed harder, as by a third one, or dragged: nothing closes
  if (!(out.closing_speed > 0)) out.closing_speed = kUnknown;
  out.relative_speed = std::max(relative_speed_of(recording, pair, has_person(pair) ? touch : span.first, out), out.closing_speed);
  for (const ContactRecord& c : recording.snapshots[span.first].contacts) {
    if (!between(pair, c) || c.impulse.isZero(0)) continue;
    out.law = law_of(model, pair, c);
    break;
  }
  share_energy(model, before, out);
  return out;
}

/// Whether what a person and an object, or two persons, exchange is a collision: in the phase one of them changes its velocity
/// along the push by more than 0.8 km/h. Who stands on a box, or leans on somebody, exchanges as much as its weight and changes
/// nothing.
bool strikes(const Model& model, const Recording& recording, const Impact& impact) {
  const Snapshot &before = recording.snapshots[impact.span.first > 0 ? impact.span.first - 1 : 0],
                 &after = recording.snapshots[impact.span.last];
  const Vec3 on_a = impact.impulse.normalized();
  const auto gained = [&](const Party& party, const Vec3& along) {
    return (velocity_of(model, party, after) - velocity_of(model, party, before)).dot(along);
  };
  return std::max(gained(impact.a.party, on_a), gained(impact.b.party, -on_a)) > kChange;
}

}  // namespace

ImpactSide side_of(const Model& model, const Recording& recording, const Party& party, const Stretch& span) {
  const auto& all = recording.snapshots;
  const Snapshot &before = all[span.first > 0 ? span.first - 1 : 0], &after = all[span.last];
  ImpactSide side;
  side.party = party;
  side.name = party.person >= 0 ? model.persons[party.person].name : model.bodies[party.bodies.front()].name;
  const Vec3 v0 = velocity_of(model, party, before), v1 = velocity_of(model, party, after);
  side.speed_before = v0.norm();
  side.speed_after = v1.norm();
  const int root = party.bodies.front();
  side.yaw_rate_before = before.bodies[root].V_WB.w.z();
  side.yaw_rate_after = after.bodies[root].V_WB.w.z();
  if (model.bodies[root].fixed || party.vehicle < 0) return side;
  side.delta_v = v1 - v0 - model.settings.gravity * (after.time - before.time);
  side.delta_v -= done_by_tyres(model, recording, party, span);
  side.delta_v.z() = 0;  // as the field counts it: in the plane of the road
  side.pdof = pdof_of(before.bodies[root].X_WB.q, side.delta_v);
  return side;
}

double changes_within_window(const Model& model, const Recording& recording, const Party& party, std::size_t first) {
  const auto& all = recording.snapshots;
  std::size_t last = first;
  while (last + 1 < all.size() && all[last + 1].time - all[first].time < kWindow - 1e-9) ++last;
  const Vec3 change = velocity_of(model, party, all[last]) - velocity_of(model, party, all[first > 0 ? first - 1 : 0]);
  return change.head<2>().norm();
}

std::vector<Stretch> stretches(const Recording& recording, const std::vector<Vec3>& push, double bound,
                               const std::function<bool(std::size_t)>& changes) {
  const std::size_t n = push.size();
  // what is exchanged from each snapshot on within the window
  std::vector<double> within(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    Vec3 sum = push[i];
    for (std::size_t k = i + 1; k < n && recording.snapshots[k].time - recording.snapshots[i].time < kWindow - 1e-9; ++k)
      sum += push[k];
    within[i] = sum.norm();
  }
  const double most = n == 0 ? 0 : *std::max_element(within.begin(), within.end());
  if (most < bound) {
    bound = kShareOfMost * most;
  } else if (changes) {
    std::vector<double> collides = within;
    for (std::size_t i = 0; i < n; ++i)
      if (collides[i] > bound && !changes(i)) collides[i] = 0;
    if (std::any_of(collides.begin(), collides.end(), [&](double w) { return w > bound; })) within = std::move(collides);
  }
  std::vector<Stretch> out;
  for (std::size_t i = 0; i < n; ++i) {
    if (!(within[i] > bound) || push[i].isZero(0)) continue;
    Stretch s{i, i};
    const double begin = recording.snapshots[i > 0 ? i - 1 : 0].time;  // the first push may be as old
    const auto time = [&](std::size_t k) { return recording.snapshots[k].time; };
    // on to the last instant from which enough is exchanged, over lulls no longer than the window
    for (std::size_t k = i + 1; k < n && time(k) - time(i) <= kWindow + 1e-9 && time(k) - begin <= kLongest; ++k)
      if (within[k] > bound) i = k;
    // the last window of the phase is part of it
    const double last = std::min(time(i) + kWindow, begin + kLongest);
    for (s.last = i; s.last + 1 < n && time(s.last + 1) < last - 1e-9;) ++s.last;
    while (s.last > s.first && push[s.last].isZero(0)) --s.last;
    // what goes on pressing, dragging or carrying beyond that is no further collision
    while (i + 1 < n && within[i + 1] > bound) ++i;
    i = std::max(i, s.last);
    out.push_back(s);
  }
  return out;
}

std::vector<Impact> impacts_of(const Model& model, const Recording& recording) {
  std::vector<Impact> out;
  for (const Pair& pair : pairs_of(model, recording)) {
    double lighter = 1e300;
    for (const Party* party : {&pair.a, &pair.b})
      if (!model.bodies[party->bodies.front()].fixed) lighter = std::min(lighter, mass_of(model, *party));
    int phase = 0;
    const std::vector<Vec3> push = pushes(model, recording, pair);
    const auto changes = [&](std::size_t i) {
      return changes_within_window(model, recording, pair.a, i) > kChange ||
             changes_within_window(model, recording, pair.b, i) > kChange;
    };
    const bool of_vehicles = has_vehicle(pair) && !has_person(pair);
    for (const Stretch& span :
         stretches(recording, push, kChange * lighter, of_vehicles ? changes : std::function<bool(std::size_t)>())) {
      const std::size_t touch = phase == 0 ? touch_of(recording, push, span.first) : span.first;
      Impact impact = impact_of(model, recording, pair, span, touch);
      if (!has_vehicle(pair) && !strikes(model, recording, impact)) continue;
      impact.phase = ++phase;
      out.push_back(std::move(impact));
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const Impact& a, const Impact& b) { return a.time < b.time; });
  return out;
}

std::vector<Event> told_events(const Model& model, const Recording& recording) {
  std::vector<Event> out = recording.events;
  for (const Impact& i : impacts_of(model, recording)) {
    const int a = i.a.party.bodies.front(), b = i.b.party.bodies.front();
    const bool told = std::any_of(recording.events.begin(), recording.events.end(), [&](const Event& e) {
      return e.kind == "impact" && std::minmax(e.body_a, e.body_b) == std::minmax(a, b);
    });
    const Pair pair{i.a.party, i.b.party};
    // a person and a vehicle have their first contact
    if (i.phase > 1 || (has_person(pair) && has_vehicle(pair)) || told) continue;
    out.push_back({i.time, "collision", i.a.part, i.b.part, i.point, i.closing_speed, i.normal, Vec3::Zero()});
  }
  std::stable_sort(out.begin(), out.end(), [](const Event& a, const Event& b) { return a.time < b.time; });
  return out;
}

}  // namespace engine
