#include "cli/output/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/output/csv.h"
#include "cli/output/json.h"
#include "cli/output/notices.h"
#include "cli/scene_run.h"
#include "engine/geometry/panels.h"
#include "engine/measure/definitions.h"
#include "engine/measure/impacts.h"
#include "engine/measure/phases.h"

namespace cli {
namespace {

const char* name_of(engine::Scheme scheme) {
  constexpr const char* kWords[] = {"stepping", "rk4", "adaptive"};
  return kWords[static_cast<int>(scheme)];
}

const char* name_of(engine::ContactLaw law) {
  constexpr const char* kWords[] = {"default_auto", "compliant", "persons_yield"};
  return kWords[static_cast<int>(law)];
}

Json vector_json(const engine::Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

/// Stiffness of what yields, where anything does: of parts of persons by name, and of a vehicle's panels to them.
Json stiffness_json(const engine::Model& model) {
  Json parts = Json::object(), panels = Json::object();
  if (!engine::yields(model.settings.contact_law, true)) return {};
  for (const engine::Person& person : model.persons)
    for (const int b : person.bodies) {
      const engine::Body& body = model.bodies[static_cast<std::size_t>(b)];
      parts[body.name] = body.surface.stiffness.at(0);
    }
  for (int p = 0; p <= static_cast<int>(engine::Panel::underside); ++p)
    panels[engine::name_of(static_cast<engine::Panel>(p))] = engine::stiffness_of(static_cast<engine::Panel>(p));
  return {{"parts", parts}, {"panels", panels}};
}

Json settings_json(const engine::Model& model) {
  const engine::Settings& s = model.settings;
  const engine::Plan plan = engine::compile(model);
  return {{"step_s", s.step},
          {"integrator", name_of(plan.integrated_by)},
          {"scheme", name_of(s.scheme)},
          {"once_a_step", plan.once_a_step},
          {"contact_model", name_of(s.contact_law)},
          {"stiffness_N_per_m", stiffness_json(model)},
          {"duration_s", s.duration},
          {"record_interval_s", s.record_interval},
          {"gravity_mps2", vector_json(s.gravity)},
          {"solver_tolerance_mps", s.solver_tolerance},
          {"touch_distance_m", s.touch_distance},
          {"locate_events", s.locate_events},
          {"sleep", s.sleep},
          {"stop_at_rest", s.stop_at_rest}};
}

/// What the value of an event is in; null where it has none.
Json unit_of(const engine::Event& e) {
  if (e.kind == "joint_broken") return "N";
  return e.kind == "rest" || e.kind == "release" ? Json(nullptr) : Json("m/s");
}

Json events_json(const engine::Model& model, const engine::Recording& recording) {
  Json out = Json::array();
  for (const engine::Event& e : engine::told_events(model, recording)) {
    Json line = {{"time_s", e.time}, {"kind", e.kind}};
    line["a"] = e.body_a < 0 ? Json(nullptr) : Json(body_name(recording, e.body_a));
    // an event between a body and nothing (rest) has no partner; one that touches has the ground
    const bool touches = e.kind.find("contact") != std::string::npos || e.kind.find("impact") != std::string::npos;
    line["b"] = e.body_b >= 0 || touches ? Json(body_name(recording, e.body_b)) : Json(nullptr);
    line["point_m"] = vector_json(e.point);
    line["value"] = number_json(e.value);
    line["unit"] = unit_of(e);
    out.push_back(line);
  }
  return out;
}

/// Has the scene several persons, or several vehicles, and is this one of them?
bool one_of_several(const engine::Model& model, const std::string& object) {
  const auto among = [&](const auto& all) {
    return all.size() > 1 && std::any_of(all.begin(), all.end(), [&](const auto& one) { return one.name == object; });
  };
  return among(model.persons) || among(model.vehicles);
}

/// A number where one object can have the metric, an object by name where several can.
Json metrics_json(const engine::Model& model, const std::vector<engine::Metric>& metrics) {
  Json out = Json::object();
  for (const engine::Metric& metric : metrics) {
    const auto same_key = [&metric](const engine::Metric& other) { return other.key == metric.key; };
    const Json value = metric.text.empty() ? Json(metric.value) : Json(metric.text);
    if (std::count_if(metrics.begin(), metrics.end(), same_key) == 1 && !one_of_several(model, metric.object)) {
      out[metric.key] = value;
    } else {
      out[metric.key][metric.object] = value;
    }
  }
  return out;
}

/// The reason by name; where several objects lack the measure or could have it, by name and object.
Json absent_json(const engine::Model& model, const std::vector<engine::AbsentMetric>& absent,
                 const std::vector<engine::Metric>& metrics) {
  Json out = Json::object();
  for (const engine::AbsentMetric& a : absent) {
    const auto alone = !one_of_several(model, a.object) &&
                       std::count_if(absent.begin(), absent.end(), [&](const auto& other) { return other.key == a.key; }) == 1 &&
                       std::none_of(metrics.begin(), metrics.end(), [&](const auto& there) { return there.key == a.key; });
    if (alone)
      out[a.key] = a.reason;
    else
      out[a.key][a.object] = a.reason;
  }
  return out;
}

Json impacts_json(const std::vector<engine::Impact>& impacts) {
  Json out = Json::array();
  for (const engine::Impact& i : impacts) {
    Json row = {{"phase", i.phase},
                {"time_s", i.time},
                {"duration_s", i.duration},
                {"body_a", i.a.name},
                {"body_b", i.b.name},
                {"law", i.law},
                {"point_m", vector_json(i.point)},
                {"normal", vector_json(i.normal)},
                {"closing_speed_mps", number_json(i.closing_speed)},
                {"relative_speed_mps", number_json(i.relative_speed)},
                {"impulse_Ns", vector_json(i.impulse)},
                {"friction_used", number_json(i.friction_used)},
                {"friction_limit", number_json(i.friction_limit)}};
    for (const auto& [side, s] : {std::pair("a", &i.a), std::pair("b", &i.b)}) {
      const auto key = [of = side](const char* before, const char* after) { return fmt::format("{}_{}_{}", before, of, after); };
      row[key("delta_v", "mps")] = s->delta_v.norm();
      row[key("delta_v", "vector_mps")] = vector_json(s->delta_v);
      row[key("own_delta_v", "mps")] = s->own_delta_v.norm();
      row[key("pdof", "deg")] = number_json(s->pdof);
      row[key("ees", "mps")] = number_json(s->ees);
      row[key("speed", "before_mps")] = number_json(s->speed_before);
      row[key("speed", "after_mps")] = number_json(s->speed_after);
      row[key("yaw_rate", "before_radps")] = number_json(s->yaw_rate_before);
      row[key("yaw_rate", "after_radps")] = number_json(s->yaw_rate_after);
    }
    row["energy_lost_J"] = number_json(i.energy_lost);
    if (*i.ees_rule) row["ees_rule"] = i.ees_rule;
    out.push_back(row);
  }
  return out;
}

/// Throw of each person by phases.
Json phases_json(const engine::Model& model, const engine::Recording& recording) {
  Json out = Json::array();
  for (std::size_t p = 0; p < model.persons.size(); ++p)
    if (const auto thrown = engine::throw_of_person(model, recording, static_cast<int>(p)))
      for (const engine::ThrowPhase& phase : thrown->phases)
        out.push_back({{"person", model.persons[p].name},
                       {"phase", phase.name},
                       {"from_s", phase.from},
                       {"to_s", phase.to},
                       {"from_m", vector_json(phase.place)},
                       {"distance_m", phase.distance}});
  return out;
}

Json energy_json(const engine::Recording& recording) {
  const engine::Energies& first = recording.snapshots.front().energies;
  const engine::Energies& last = recording.snapshots.back().energies;
  Json by_effect = Json::object();
  for (std::size_t i = 0; i < last.dissipated.size() && i < recording.effect_names.size(); ++i) {
    if (last.dissipated[i] != 0) by_effect[recording.effect_names[i]] = last.dissipated[i];
  }
  return {{"initial_J", first.kinetic + first.potential},
          {"final_J", last.kinetic + last.potential},
          {"dissipated_J", by_effect},
          {"added_J", last.added},
          {"residual_J", last.residual}};
}

Json diagnostics_json(const engine::Diagnostics& d) {
  return {{"max_joint_gap_m", d.max_joint_gap},
          {"max_joint_angle_error_rad", d.max_joint_angle_error},
          {"max_penetration_m", d.max_penetration},
          {"max_compression_m", d.max_compression},
          {"rest_penetration_m", d.rest_penetration},
          {"max_solver_residual", d.max_solver_residual},
          {"max_energy_rise_J", d.max_energy_rise},
          {"energy_turned_over_J", d.energy_turned_over},
          {"max_unexplained_J", d.max_unexplained},
          {"max_effect_gain_J", d.max_effect_gain},
          {"contact_sweeps", d.contact_sweeps},
          {"substeps", d.substeps},
          {"warnings", d.warnings}};
}

double per_second(double amount, double seconds) {
  return seconds > 0 ? amount / seconds : 0;
}

Json cost_json(const engine::Recording& recording) {
  Json effects = Json::array();
  for (const engine::EffectCost& cost : recording.costs) {
    effects.push_back({{"effect", cost.effect}, {"calls", cost.calls}, {"wall_s", cost.wall_s}});
  }
  Json phases = Json::array();
  for (const engine::EffectCost& cost : recording.phases) {
    phases.push_back({{"phase", cost.effect}, {"calls", cost.calls}, {"wall_s", cost.wall_s}});
  }
  Json longest = nullptr;
  if (const auto& step = recording.longest_step)
    longest = {{"processor_s", step->processor_s}, {"time_s", step->time}, {"bodies", step->bodies}};
  return {{"steps", recording.steps},
          {"longest_step", longest},
          {"wall_s", recording.wall_s},
          {"steps_per_s", per_second(static_cast<double>(recording.steps), recording.wall_s)},
          {"realtime_factor", per_second(recording.end_time(), recording.wall_s)},
          {"effects", effects},
          {"phases", phases}};
}

}  // namespace

std::string slow_step(const engine::Recording& recording) {
  constexpr double kSlow = 1;  // [s]
  const auto& step = recording.longest_step;
  if (!step || step->processor_s <= kSlow) return {};
  return fmt::format("the step to {:.4g} s took {:.3g} s of processor time: {}", step->time, step->processor_s,
                     fmt::join(step->bodies, ", "));
}

std::string scheme_in_words(const engine::Model& model, const engine::Plan& plan) {
  if (plan.once_a_step.empty()) return {};
  const std::string asked = name_of(model.settings.scheme), what = fmt::format("{}", fmt::join(plan.once_a_step, ", "));
  if (plan.integrated_by == model.settings.scheme)
    return fmt::format("scheme {} solves once a step, as stepping does: {}", asked, what);
  const bool law = std::find(plan.once_a_step.begin(), plan.once_a_step.end(), "contacts") != plan.once_a_step.end();
  return fmt::format(
      "scheme {} is integrated as {}, to the last bit: all it could take into its stages is solved once a step: {}{}", asked,
      name_of(plan.integrated_by), what, law ? "; contact_law = \"compliant\" would take the contacts" : "");
}

Json plan_json(const std::vector<engine::PlanLine>& lines) {
  Json out = Json::array();
  for (const engine::PlanLine& line : lines) {
    out.push_back({{"effect", line.effect}, {"active", line.active}, {"forced", line.forced}, {"reason", line.reason}});
    if (!line.left_out.empty()) out.back()["left_out"] = line.left_out;
    if (line.not_before > 0 && std::isfinite(line.not_before)) out.back()["not_before_s"] = line.not_before;
    if (!line.acted.told) continue;
    const auto moment = [](double time) { return time < 0 ? Json() : Json(time); };
    out.back()["acted"] = {
        {"in_reach_s", moment(line.acted.in_reach)}, {"first_s", moment(line.acted.first)}, {"last_s", moment(line.acted.last)}};
  }
  return out;
}

Json summary_json(const scenes::Scene& scene, const engine::Recording& recording, const std::vector<engine::Metric>& metrics) {
  Json out;
  out["schema"] = 1;
  out["version"] = CRASHREEL_VERSION;
  out["scene"] = {{"title", scene.title}, {"path", scene.path.string()}, {"sha256", scene.sha256}, {"overrides", scene.overrides}};
  out["settings"] = settings_json(scene.model);
  out["plan"] = plan_json(recording.plan);
  out["events"] = events_json(scene.model, recording);
  out["metrics"] = metrics_json(scene.model, metrics);
  const auto absent = engine::absent_metrics(scene.model, recording, metrics);
  if (!absent.empty()) out["absent"] = absent_json(scene.model, absent, metrics);
  out["impacts"] = impacts_json(engine::impacts_of(scene.model, recording));
  if (Json phases = phases_json(scene.model, recording); !phases.empty()) out["phases"] = phases;
  out["energy"] = energy_json(recording);
  out["diagnostics"] = diagnostics_json(recording.diagnostics);
  out["cost"] = cost_json(recording);
  out["recording"] = {{"end_s", recording.end_time()},
                      {"snapshots", recording.snapshots.size()},
                      {"hash", fmt::format("{:016x}", engine::hash(recording))}};
  if (const auto& failure = recording.failure) {
    out["failure"] = {
        {"time_s", failure->time}, {"body", failure->body}, {"effect", failure->effect}, {"message", failure->message}};
  }
  return out;
}

namespace {

/// What rounds to nothing has no sign.
std::string without_sign_of_zero(std::string number) {
  if (number.starts_with('-') && number.find_first_of("123456789") == std::string::npos) number.erase(0, 1);
  return number;
}

/// A direction, counted above -180 deg: straight from behind is one direction and has one number.
std::string angle_text(double degrees) {
  const std::string number = without_sign_of_zero(fmt::format("{:.1f}", degrees));
  return number == "-180.0" ? "180.0" : number;
}

/// As many digits as the measure bears: the rest of a number that hangs on stances and panels is noise. What a free body does is
/// exact to the step and keeps six.
std::string digits_of(const engine::Metric& metric, const engine::Definition* known, bool of_person) {
  const std::string unit = known ? known->unit : "", key = metric.key;
  const bool exact = key == "travel_m" || key == "turned_deg" || key == "rebound_height_m";
  if ((exact && !of_person) || !known) return fmt::format("{:.6g}", metric.value);
  if (key == "quarter_turns" || key == "ground_strikes") return fmt::format("{:.0f}", metric.value);
  if (unit == "s") return fmt::format("{:.3f}", metric.value);
  if (unit == "deg") return angle_text(metric.value);
  if (unit == "g" || key.starts_with("hic")) return fmt::format("{:.0f}", metric.value);
  return without_sign_of_zero(fmt::format("{:.2f}", metric.value));
}

/// Of a criterion over the whole run, what the touches of one kind give by themselves when they are what decided it. Their
/// stretches end 5 ms from the touch: a tail of the blow can be missing, but a power of 2.5 makes the peak count.
constexpr double kDecides = 0.8;

/// The fixed body that the person of that name met with its head at the worst (engine::struck_at_worst).
engine::StruckAtWorst struck_by_name(const scenes::Scene& scene, const engine::Recording& recording, const std::string& name) {
  for (int p = 0; p < static_cast<int>(scene.model.persons.size()); ++p)
    if (scene.model.persons[static_cast<std::size_t>(p)].name == name) return engine::struck_at_worst(scene.model, recording, p);
  return {};
}

/// Beside a criterion that road or wall decided, which of them. Who came down had one fall of many that could have been. The worst
/// of all may be of neither: a head strikes the person's own arm, or is shaken by a blow to the trunk.
std::string decided(const engine::Metric& metric, const std::vector<engine::Metric>& all, const scenes::Scene& scene,
                    const engine::Recording& recording) {
  if (metric.key != "hic15" && metric.key != "hic15_ground") return "";
  const auto of = [&](const char* key) {
    double out = 0;
    for (const engine::Metric& m : all)
      if (m.key == key && m.object == metric.object) out = m.value;
    return out;
  };
  const double by_vehicle = of("hic15_vehicle"), by_ground = of("hic15_ground"), by_object = of("hic15_object");
  if (metric.key == "hic15" && by_vehicle >= kDecides * metric.value && by_vehicle >= std::max(by_ground, by_object)) return "";
  if (metric.key == "hic15" && by_object >= kDecides * metric.value && by_object >= by_ground)
    return ", of an object or another person";
  if (by_ground < kDecides * metric.value) return ", of neither vehicle nor road alone";
  const auto [body, came_down] = struck_by_name(scene, recording, metric.object);
  const std::string name = body < 0 ? "the road" : scene.model.bodies[static_cast<std::size_t>(body)].name;
  return ", of " + name + (came_down ? ": scatters widely" : "");
}

/// Beside a criterion of one kind of touch: when its window begins, and by whom.
std::string struck_at(const engine::Metric& metric, const std::vector<engine::Metric>& all) {
  if (metric.key != "hic15_vehicle" && metric.key != "hic15_ground" && metric.key != "hic15_object") return "";
  std::string when, by;
  for (const engine::Metric& m : all) {
    if (m.object != metric.object) continue;
    if (m.key == metric.key + "_s") when = fmt::format(" at {:.3f} s", m.value);
    if (m.key == metric.key + "_by" && metric.key != "hic15_ground") by = ", by " + m.text;
  }
  return when + by;
}

/// Beside the way of who came down and was taken along again: no friction follows from it.
const char* dragged(const engine::Metric& metric, const scenes::Scene& scene, const engine::Recording& recording) {
  if (metric.key != "slide_m") return "";
  for (int p = 0; p < static_cast<int>(scene.model.persons.size()); ++p) {
    if (scene.model.persons[static_cast<std::size_t>(p)].name != metric.object) continue;
    const auto thrown = engine::throw_of_person(scene.model, recording, p);
    if (thrown && thrown->dragged) return ", pushed by a vehicle on the way";
  }
  return "";
}

bool is_person(const scenes::Scene& scene, const std::string& name) {
  const auto& persons = scene.model.persons;
  return std::any_of(persons.begin(), persons.end(), [&](const engine::Person& p) { return p.name == name; });
}

using Absent = std::vector<engine::AbsentMetric>;

bool lacks(const Absent& absent, const char* key, const std::string& object) {
  return std::any_of(absent.begin(), absent.end(), [&](const auto& a) { return a.key == key && a.object == object; });
}

/// Beside the way of a phase that leads back: the ways are parts of the line from first touch to rest.
const char* backwards(const engine::Metric& metric) {
  constexpr double kSeen = 0.005;  // [m] less is printed as none
  constexpr const char* kPhases[] = {"contact_m", "carried_m", "airborne_m", "fall_m", "landing_m", "slide_m"};
  const bool phase = std::any_of(std::begin(kPhases), std::end(kPhases), [&](const char* key) { return metric.key == key; });
  return phase && metric.value < -kSeen ? ", against the throw" : "";
}

/// What a screen has room for: the main ones, and the ways of who never came down, or that the others do not add up to the throw
/// without. The rest stands in summary.json.
bool is_shown(const engine::Metric& metric, const engine::Definition* known, const Absent& absent) {
  if (!known || known->main) return true;
  constexpr double kRounding = 0.005;  // [m] of the throw as it is printed
  return (metric.key == "contact_m" || metric.key == "carried_m" || metric.key == "landing_m") &&
         (std::abs(metric.value) >= kRounding || lacks(absent, "landing_s", metric.object));
}

/// Names at the left, values in one column.
std::string aligned(const std::vector<std::pair<std::string, std::string>>& lines) {
  std::size_t width = 0;
  for (const auto& [name, value] : lines) width = std::max(width, name.size());
  std::string out;
  for (const auto& [name, value] : lines) out += fmt::format("  {:<{}} {}\n", name, width, value);
  return out;
}

}  // namespace

std::string summary_text(const scenes::Scene& scene, const engine::Recording& recording,
                         const std::vector<engine::Metric>& metrics) {
  const engine::Diagnostics& d = recording.diagnostics;
  const engine::Energies& first = recording.snapshots.front().energies;
  const engine::Energies& last = recording.snapshots.back().energies;
  const double initial = first.kinetic + first.potential;
  std::vector<std::pair<std::string, std::string>> lines;
  const auto line = [&lines](const std::string& name, const std::string& value) { lines.emplace_back(name, value); };
  const Absent absent = engine::absent_metrics(scene.model, recording, metrics);
  for (const engine::Metric& metric : metrics) {
    const engine::Definition* known = engine::definition_of(metric.key);
    if (!is_shown(metric, known, absent)) continue;
    line(metric.object.empty() ? metric.key : metric.key + " " + metric.object,
         metric.text.empty() ? digits_of(metric, known, is_person(scene, metric.object)) + struck_at(metric, metrics) +
                                   decided(metric, metrics, scene, recording) +
                                   (is_so_far(metric, metrics, absent) ? " so far, still moving at the end" : "") +
                                   backwards(metric) + dragged(metric, scene, recording)
                             : metric.text);
  }
  // whose it is, where another has it
  std::vector<std::string> missing_names;
  for (const engine::AbsentMetric& a : absent) {
    if (a.key.starts_with("rest_") && a.key != "rest_s") continue;  // place and heading of who does not rest
    const bool elsewhere = std::any_of(metrics.begin(), metrics.end(), [&](const auto& m) { return m.key == a.key; });
    const std::string name = elsewhere && !a.object.empty() ? a.key + " " + a.object : a.key;
    if (std::find(missing_names.begin(), missing_names.end(), name) == missing_names.end()) missing_names.push_back(name);
  }
  const std::string missing = fmt::format("{}", fmt::join(missing_names, ", "));
  if (!missing.empty()) line("absent", missing + " (summary.json has the reasons)");
  // what is left when all is at rest is height over the world's origin, and springs
  line("energy", fmt::format("{:.6g} J at first, {:.6g} J at last ({:.2g} J in motion), unexplained {:.3g} J", initial,
                             last.kinetic + last.potential, last.kinetic, last.residual));
  line("largest joint gap", fmt::format("{:.3g} m", d.max_joint_gap));
  line("penetration", fmt::format("{:.3g} m at most, {:.3g} m at the end", d.max_penetration, d.rest_penetration));
  if (d.max_compression > 0) line("compression", fmt::format("{:.3g} m at most", d.max_compression));
  line("solver residual", fmt::format("{:.3g} m/s at most", d.max_solver_residual));
  line("simulated", fmt::format("{:.4g} s in {:.3g} s, {} steps, {:.3g} times real time", recording.end_time(), recording.wall_s,
                                recording.steps, per_second(recording.end_time(), recording.wall_s)));
  for (const std::string& warning : d.warnings) line("warning", warning);
  if (const std::string slow = slow_step(recording); !slow.empty()) line("warning", slow);
  line("recording hash", fmt::format("{:016x}", engine::hash(recording)));
  return heading_of(scene) + "\n" + aligned(lines);
}

}  // namespace cli
