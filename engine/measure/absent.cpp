// Which measures a run does not define, and why.
#include <algorithm>

#include "engine/measure/metrics.h"
#include "engine/measure/passage.h"
#include "engine/measure/phases.h"
#include "engine/measure/vehicle_events.h"

namespace engine {
namespace {

class Absences {
 public:
  explicit Absences(const std::vector<Metric>& there) : there_(there) {}
  /// Notes the reason, unless the measure is there.
  void note(const char* key, const std::string& object, const std::string& reason) {
    const bool found =
        std::any_of(there_.begin(), there_.end(), [&](const Metric& m) { return m.key == key && m.object == object; });
    if (!found) out.push_back({key, object, reason});
  }
  std::vector<AbsentMetric> out;

 private:
  const std::vector<Metric>& there_;
};

/// Of somebody or something that moved, by its last quarter of a second.
const char* why_no_rest(const Model& model, const Recording& recording, const Party& party) {
  constexpr double kStillSpeed = 0.05, kStillTurn = 0.3, kStillTime = 0.25;  // [m/s], [rad/s], [s] as in the definition of rest_s
  const auto& all = recording.snapshots;
  const auto moves = [&](const Snapshot& s) {
    const bool turns = party.vehicle >= 0 && s.bodies[party.bodies.front()].V_WB.w.norm() > kStillTurn;
    return turns || velocity_of(model, party, s).norm() > kStillSpeed;
  };
  if (moves(all.back())) return "still moving when the run ends";
  const double from = all.back().time - kStillTime;
  if (from < all.front().time || std::any_of(all.begin(), all.end(), [&](const Snapshot& s) { return s.time >= from && moves(s); }))
    return "still for less than 0.25 s when the run ends";
  return "creeping on or rocking when the run ends";
}

bool wheel_touched(const Recording& recording, const Party& party) {
  return std::any_of(recording.snapshots.begin(), recording.snapshots.end(), [&](const Snapshot& s) {
    return std::any_of(s.contacts.begin(), s.contacts.end(),
                       [&](const ContactRecord& c) { return c.shapes.b == ShapeKind::tyre && !push_on(party, c).isZero(0); });
  });
}

void absent_throw(const Model& model, const Recording& recording, int p, Absences& absent) {
  const std::string& name = model.persons[p].name;
  const auto t = throw_of_person(model, recording, p);
  constexpr double kWent = 1e-3;  // [m]
  const Party party{p, -1, model.persons[p].bodies};
  const Snapshot &first = recording.snapshots.front(), &last = recording.snapshots.back();
  const Vec3 way = centre_of_mass(model, party, last) - centre_of_mass(model, party, first);
  const bool moved = t || velocity_of(model, party, last).norm() > 0 || way.norm() > kWent;
  absent.note("rest_s", name, moved ? why_no_rest(model, recording, party) : "nothing touched it: it stands as it stood");
  if (!t) {
    absent.note("throw_distance_m", name, "no vehicle touched it");
    return;
  }
  if (wheel_touched(recording, party)) absent.note("run_over_s", name, "a wheel touched it, and did not stand on it");
  const char* up =
      t->lay ? "it lay on the ground when it was struck" : "the trunk did not come down on the ground after the first touch";
  absent.note("landing_s", name, up);
  absent.note("first_ground_contact_s", name, up);
  absent.note("carried_m", name, "never as fast as the vehicle while it pushed");
  const char* no_landing = t->lay ? "it lay on the ground when it was struck" : "it did not land";
  absent.note("airborne_m", name, t->landed ? "something touched or held it at least every 50 ms before it landed" : no_landing);
  const char* flew = t->flew ? "it flew for 50 ms or more" : "a vehicle pushed it until it landed";
  absent.note("fall_m", name, t->landed ? flew : no_landing);
  absent.note("landing_m", name, no_landing);
  absent.note("slide_m", name, t->lay ? "a vehicle pushed it until it rested, or the run ended" : "it did not land");
}

const char* const kByWheel = "a wheel met the head: its tyre is rigid and gives no history of forces";

void absent_head(const Model& model, const Recording& recording, int p, Absences& absent) {
  const Person& person = model.persons[p];
  const bool struck = std::any_of(recording.events.begin(), recording.events.end(),
                                  [&](const Event& e) { return e.kind == "head_impact" && e.body_a == person.head; });
  if (!struck) {
    absent.note("head_impact_s", person.name, "no vehicle touched the head");
  } else {
    absent.note("head_impact_panel", person.name, "the head met a wheel or a two-wheeler, or the mesh tells no panels");
    absent.note("wrap_around_distance_m", person.name,
                "the head met no front, or a wheel, or a place no tape from the front reaches");
  }
  const std::string law = why_no_head_injury(model);
  const bool wheel = wheel_met_head(model, recording, p);
  const std::string none = wheel ? kByWheel : "the head touched neither vehicle nor ground";
  for (const char* key : {"hic15", "hic36", "three_ms_g"}) absent.note(key, person.name, law.empty() ? none : law);
  absent.note("hic15_vehicle", person.name, !law.empty() ? law : wheel ? kByWheel : "no vehicle touched the head");
  absent.note("hic15_ground", person.name, !law.empty() ? law : wheel ? kByWheel : "the head did not touch the ground");
  absent.note("hic15_object", person.name, law.empty() ? "no object and nobody else touched the head" : law);
  if (!law.empty()) absent.note("peak_acceleration_mps2", person.name, law);
}

/// What the hardest impact of a vehicle does not tell of it.
void absent_at_worst(const Model& model, const Vehicle& v, const std::vector<Impact>& impacts, Absences& absent) {
  const Impact* worst = hardest_impact(model, impacts, model.bodies[v.body].vehicle);
  if (!worst) {
    absent.note("ees_mps", v.name, "it was struck through its coupling, not itself");
    absent.note("pdof_deg", v.name, "its velocity did not change");
    return;
  }
  absent.note("ees_mps", v.name, worst->no_ees);
  absent.note("pdof_deg", v.name, worst->impulse.norm() > 0 ? "it lay on its side or roof" : "its velocity did not change");
}

}  // namespace

std::vector<AbsentMetric> absent_metrics(const Model& model, const Recording& recording, const std::vector<Metric>& there) {
  Absences absent(there);
  for (int p = 0; p < static_cast<int>(model.persons.size()); ++p) {
    absent_throw(model, recording, p, absent);
    absent_head(model, recording, p, absent);
  }
  const std::vector<Impact> impacts = impacts_of(model, recording);
  for (const Vehicle& v : model.vehicles) {
    for (const char* key : {"rest_s", "rest_x_m", "rest_y_m", "rest_heading_deg"})
      absent.note(key, v.name, model.bodies[v.body].fixed ? "it is fixed" : why_no_rest(model, recording, party_of(model, v.body)));
    const auto has = [&](const char* key) {
      return std::any_of(there.begin(), there.end(), [&](const Metric& m) { return m.key == key && m.object == v.name; });
    };
    if (has("quarter_turns"))
      absent.note("roll_drag_factor", v.name,
                  has("rest_x_m") ? "it struck a vehicle or an object as it rolled, and what that took is no drag"
                                  : "still moving when the run ends");
    if (!has("delta_v_mps"))
      absent.note("delta_v_mps", v.name,
                  model.bodies[v.body].fixed                                     ? "it is fixed"
                  : went_through(model, recording, model.bodies[v.body].vehicle) ? "it went through an object"
                                                                                 : "it touched no person, vehicle or object");
    else
      absent_at_worst(model, v, impacts, absent);
  }
  return absent.out;
}

}  // namespace engine
