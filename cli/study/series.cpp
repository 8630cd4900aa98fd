#include "cli/study/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/plan.h"

namespace cli::study {
namespace {

constexpr int kCoarser = 4;  // the ladder begins at this many times the scene's own step

std::string in_ms(double seconds) {
  return fmt::format("{:.7g} ms", 1e3 * seconds);
}

/// Steps between two recorded instants.
int instants_apart(const engine::Settings& s) {
  return std::max(1, static_cast<int>(std::lround(s.record_interval / s.step)));
}

/// The scene's step for a second opinion. Recorded instants are the same, and between two of them no step ends where one of the
/// scene's own does: a ladder of the same steps would share the phase of every touch.
double other_step(const engine::Settings& s) {
  const int apart = instants_apart(s);
  if (apart < 3) return 0.7 * s.step;
  int steps = static_cast<int>(std::lround(1.4 * apart));
  while (std::gcd(steps, apart) > 1) ++steps;
  return s.step * apart / steps;
}

/// `halvings` of four times the step.
double rung(double step, int halvings) {
  return kCoarser * step / std::pow(2.0, halvings);
}

std::string step_override(double step) {
  return "simulation.step=" + fmt::format("{:.12g} ms", 1e3 * step);
}

/// A scene cannot be recorded more often than it is computed.
void keep_recordable(Setting& setting, const engine::Settings& s, double step) {
  if (step > s.record_interval) setting.overrides.push_back("simulation.record_interval=" + fmt::format("{:.12g} ms", 1e3 * step));
}

/// Steps from four times the given one, halved; the finest two with fewer members, for they cost most of the study.
std::vector<Setting> steps_of(const scenes::Scene& scene, const StudyOptions& options, double step,
                              const std::vector<std::string>& also, bool own) {
  std::vector<Setting> out;
  for (int k = 0; k <= options.halvings; ++k) {
    const double h = rung(step, k);
    Setting setting{"step " + in_ms(h), {step_override(h)}, h, 0, false};
    setting.overrides.insert(setting.overrides.end(), also.begin(), also.end());
    keep_recordable(setting, scene.model.settings, h);
    setting.members = k + 2 > options.halvings ? std::min(3, options.members) : options.members;
    setting.own = own && std::abs(h - step) < 1e-9 * step;
    out.push_back(setting);
  }
  return out;
}

const char* word(engine::Scheme scheme) {
  constexpr const char* kWords[] = {"stepping", "rk4", "adaptive"};
  return kWords[static_cast<int>(scheme)];
}

const char* word(engine::ContactLaw law) {
  constexpr const char* kWords[] = {"default_auto", "compliant", "persons_yield"};
  return kWords[static_cast<int>(law)];
}

using Make = Series (*)(const scenes::Scene&, const StudyOptions&);

/// What every series but the scene's own asks of a scene: that it means something for it.
bool has_contacts(const scenes::Scene& scene) {
  return scene.model.ground.plane || scene.model.ground.terrain || scene.model.bodies.size() > 1;
}

Series own_steps(const scenes::Scene& scene, const StudyOptions& options) {
  const engine::Settings& s = scene.model.settings;
  if (s.scheme == engine::Scheme::adaptive) {
    Series series{word(s.scheme), "tolerance", "tolerance and longest step tightened", true, false, {}};
    for (int k = 0; k <= options.halvings; ++k) {
      const double tolerance = 16 * s.adaptive_tolerance / std::pow(4.0, k), longest = rung(s.step, k);
      Setting setting{fmt::format("tolerance {:.3g} m", tolerance),
                      {fmt::format("simulation.adaptive_tolerance={:.9g} m", tolerance), step_override(longest)},
                      tolerance,
                      options.members,
                      k == 2};
      keep_recordable(setting, s, longest);
      series.settings.push_back(setting);
    }
    return series;
  }
  return {word(s.scheme), "step", "the scene's own scheme, step halved", true, false, steps_of(scene, options, s.step, {}, true)};
}

Series other_events(const scenes::Scene& scene, const StudyOptions& options) {
  if (!has_contacts(scene)) return {};
  const bool located = scene.model.settings.locate_events;
  StudyOptions few = options;
  few.members = 0;
  few.halvings = options.halvings - 1;
  return {std::string(word(scene.model.settings.scheme)) + (located ? kNotLocated : ", events located"),
          "step",
          "impacts at the end of the step instead of inside it",
          false,
          false,
          steps_of(scene, few, scene.model.settings.step, {fmt::format("simulation.locate_events={}", !located)}, false)};
}

Series scheme_steps(const scenes::Scene& scene, const StudyOptions& options, engine::Scheme scheme, bool located) {
  if (scene.model.settings.scheme == scheme || (!located && !has_contacts(scene))) return {};
  StudyOptions few = options;
  few.members = 0;
  return {
      std::string(word(scheme)) + (located ? "" : kNotLocated),
      "step",
      "another scheme at steps of its own, halved",
      located,
      false,
      steps_of(scene, few, other_step(scene.model.settings),
               {fmt::format("simulation.scheme={}", word(scheme)), fmt::format("simulation.locate_events={}", located)}, false)};
}

Series stepping_steps(const scenes::Scene& scene, const StudyOptions& options) {
  return scheme_steps(scene, options, engine::Scheme::stepping, true);
}
Series rk4_steps(const scenes::Scene& scene, const StudyOptions& options) {
  return scheme_steps(scene, options, engine::Scheme::rk4, true);
}
Series rk4_plain_steps(const scenes::Scene& scene, const StudyOptions& options) {
  return scheme_steps(scene, options, engine::Scheme::rk4, false);
}

Series adaptive_tolerances(const scenes::Scene& scene, const StudyOptions& options) {
  const engine::Settings& s = scene.model.settings;
  if (s.scheme == engine::Scheme::adaptive) return {};
  Series series{"adaptive", "tolerance", "steps chosen by the program, tolerance and longest step tightened", true, false, {}};
  // a tolerance alone seldom binds: then all its levels take the longest step, and agree on that step's error
  for (int k = 0; k <= options.halvings; ++k) {
    const double longest = rung(other_step(s), k);
    Setting setting{
        fmt::format("tolerance 1e-{} m", k + 3),
        {"simulation.scheme=adaptive", fmt::format("simulation.adaptive_tolerance=1e-{} m", k + 3), step_override(longest)},
        std::pow(10.0, -k - 3),
        0,
        false};
    keep_recordable(setting, s, longest);
    series.settings.push_back(setting);
  }
  return series;
}

Series solver_tolerances(const scenes::Scene& scene, const StudyOptions&) {
  if (!solver_decides(scene)) return {};
  Series series{kSolverSeries, "tolerance", "the residual at which the contact solver stops", false, false, {}};
  const double own = scene.model.settings.solver_tolerance;
  // to a hundredth of the scene's own: what that leaves is measured, not assumed
  for (int k = 3; k >= -2; --k) {
    const double tolerance = own * std::pow(10.0, k);
    series.settings.push_back({fmt::format("solver tolerance {:.0e} m/s", tolerance),
                               {fmt::format("simulation.solver_tolerance={:.9g} m/s", tolerance)},
                               tolerance,
                               0,
                               false});
  }
  series.own_fineness = own;
  return series;
}

Series touch_distances(const scenes::Scene& scene, const StudyOptions&) {
  const engine::Settings& s = scene.model.settings;
  if (!has_contacts(scene) || s.contact_law == engine::ContactLaw::compliant) return {};
  Series series{"touch distance", "bound", "how near rigid surfaces come before they exchange an impact", false, false, {}};
  for (const double share : {4.0, 1.0, 0.25, 0.0625})
    series.settings.push_back({fmt::format("touch distance {:.3g} mm", 1e3 * share * s.touch_distance),
                               {fmt::format("simulation.touch_distance={:.9g} mm", 1e3 * share * s.touch_distance)},
                               share * s.touch_distance,
                               0,
                               false});
  series.own_fineness = s.touch_distance;
  return series;
}

Series mesh_details(const scenes::Scene& scene, const StudyOptions&) {
  std::vector<std::string> meshed;
  double own = 0;
  for (const engine::Vehicle& vehicle : scene.model.vehicles)
    if (const auto* mesh = std::get_if<engine::MeshShape>(&scene.model.bodies[vehicle.body].shape)) {
      meshed.push_back(vehicle.name);
      own = std::max(own, mesh->tolerance);
    }
  if (meshed.empty()) return {};
  Series series{"mesh detail", "bound", "the detail of the collision mesh", false, false, {}};
  for (const double bound : {0.04, 0.02, 0.01, 0.005, 0.0025, 0.0}) {
    Setting setting{bound > 0 ? fmt::format("mesh within {:g} mm", 1e3 * bound) : "full mesh", {}, bound, 0, false};
    for (const std::string& name : meshed)
      setting.overrides.push_back(fmt::format("vehicle.{}.mesh_tolerance={:g} mm", name, 1e3 * bound));
    series.settings.push_back(setting);
  }
  series.own_fineness = own;
  return series;
}

Series contact_points(const scenes::Scene& scene, const StudyOptions&) {
  // where no mesh touches by points there is nothing to number
  const engine::Plan plan = engine::compile(scene.model);
  if (std::none_of(plan.lines.begin(), plan.lines.end(),
                   [](const engine::PlanLine& line) { return line.active && line.effect == "bodywork_contact"; }))
    return {};
  Series series{"contact points", "number", "at how many points two meshes hold each other", false, false, {}};
  const int own = scene.model.settings.contacts_per_pair;
  for (const int number : {4, 6, 10, 16, 24, 40})
    series.settings.push_back({fmt::format("{} points a pair", number),
                               {fmt::format("simulation.contacts_per_pair={}", number)},
                               1.0 / number,
                               0,
                               false});
  series.own_fineness = 1.0 / own;
  return series;
}

Series recorded_instants(const scenes::Scene& scene, const StudyOptions&) {
  const engine::Settings& s = scene.model.settings;
  const int own = instants_apart(s);
  Series series{"recorded instants", "interval", "how often the motion is recorded", false, false, {}};
  // finer ones that do not divide each other: a moment that is one of those recorded is then told from one that is not
  for (const int k : {4 * own, 2 * own, own, 3, 2, 1}) {
    if (!series.settings.empty() && k * s.step >= series.settings.back().fineness) continue;
    series.settings.push_back(
        {"recorded every " + in_ms(k * s.step), {"simulation.record_interval=" + in_ms(k * s.step)}, k * s.step, 0, false});
  }
  series.own_fineness = own * s.step;
  return series;
}

Series starts_on_the_grid(const scenes::Scene& scene, const StudyOptions&) {
  const auto moves = [](const engine::Body& body) { return !body.fixed; };
  if (std::count_if(scene.model.bodies.begin(), scene.model.bodies.end(), moves) < 2) return {};
  Series series{"start", kStartsVary, "the grid that the start lies on", false, false, {}};
  constexpr int kDraws = 4;
  for (int draw = kDraws; draw >= 0; --draw)
    series.settings.push_back({draw > 0 ? fmt::format("start {} within 15 nm", draw) : "own start", {}, 1, 0, false, draw});
  series.own_fineness = 1;
  return series;
}

Series other_contact_law(const scenes::Scene& scene, const StudyOptions&) {
  if (!has_contacts(scene)) return {};
  using engine::ContactLaw;
  const ContactLaw own = scene.model.settings.contact_law;
  const ContactLaw other = own == ContactLaw::default_auto && scene.model.persons.empty() ? ContactLaw::compliant
                           : own == ContactLaw::default_auto                              ? ContactLaw::persons_yield
                                                                                          : ContactLaw::default_auto;
  Series series{fmt::format("{} law", word(other)),
                "step",
                "another law of contact: its difference is modelling, not numerics",
                false,
                true,
                {}};
  for (const int k : {2, 1}) {
    const double h = scene.model.settings.step / (3 - k);
    series.settings.push_back({fmt::format("{} law, step {}", word(other), in_ms(h)),
                               {fmt::format("simulation.contact_law={}", word(other)), "simulation.step=" + in_ms(h)},
                               h,
                               0,
                               false});
  }
  return series;
}

/// The table of series. One that does not mean anything for a scene comes back empty; one whose keys the scene refuses is left out.
constexpr Make kSeries[] = {own_steps,           other_events,       stepping_steps,   rk4_steps,    rk4_plain_steps,
                            adaptive_tolerances, solver_tolerances,  touch_distances,  mesh_details, contact_points,
                            recorded_instants,   starts_on_the_grid, other_contact_law};

}  // namespace

bool solver_decides(const scenes::Scene& scene) {
  const engine::Settings& s = scene.model.settings;
  const bool forces = s.contact_law == engine::ContactLaw::compliant && s.scheme != engine::Scheme::stepping;
  return has_contacts(scene) && !forces;
}

std::vector<Series> series_for(const scenes::Scene& scene, const StudyOptions& options, const Accepts& accepts) {
  std::vector<Series> out;
  for (const Make make : kSeries) {
    Series series = make(scene, options);
    if (series.settings.empty()) continue;
    if (accepts(series.settings.front().overrides)) out.push_back(std::move(series));
  }
  return out;
}

}  // namespace cli::study
