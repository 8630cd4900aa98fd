#include "cli/study/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/plan.h"

namespace cli::study {
namespace {

constexpr int kCoarser = 4;  // the ladder begins at this many times the scene's own step

std::string in_ms(double seconds) {
  return fmt::format("{:.7g} ms", 1e3 * seconds);
}

/// Steps from four times the scene's own, halved; the finest two with fewer members, for they cost most of the study.
std::vector<Setting> steps_of(const scenes::Scene& scene, const StudyOptions& options, const std::vector<std::string>& also,
                              bool own) {
  std::vector<Setting> out;
  const double step = scene.model.settings.step;
  for (int k = 0; k <= options.halvings; ++k) {
    const double h = kCoarser * step / std::pow(2.0, k);
    Setting setting{"step " + in_ms(h), {"simulation.step=" + in_ms(h)}, {}, h, 0, false};
    setting.overrides.insert(setting.overrides.end(), also.begin(), also.end());
    // a scene cannot be recorded more often than it is computed
    if (h > scene.model.settings.record_interval) setting.overrides.push_back("simulation.record_interval=" + in_ms(h));
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
    // the step of this scheme is its tolerance
    Series series{word(s.scheme), "tolerance", "tolerance of a step", true, false, {}};
    for (int k = 0; k <= options.halvings; ++k) {
      const double tolerance = 16 * s.adaptive_tolerance / std::pow(4.0, k);
      series.settings.push_back({fmt::format("tolerance {:.3g} m", tolerance),
                                 {fmt::format("simulation.adaptive_tolerance={:.9g} m", tolerance)},
                                 {},
                                 tolerance,
                                 options.members,
                                 k == 2});
    }
    return series;
  }
  return {word(s.scheme), "step", "the scene's own scheme, step halved", true, false, steps_of(scene, options, {}, true)};
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
          steps_of(scene, few, {fmt::format("simulation.locate_events={}", !located)}, false)};
}

Series scheme_steps(const scenes::Scene& scene, const StudyOptions& options, engine::Scheme scheme, bool located) {
  if (scene.model.settings.scheme == scheme || (!located && !has_contacts(scene))) return {};
  StudyOptions few = options;
  few.members = 0;
  return {
      std::string(word(scheme)) + (located ? "" : kNotLocated),
      "step",
      "another scheme, step halved",
      located,
      false,
      steps_of(scene, few, {fmt::format("simulation.scheme={}", word(scheme)), fmt::format("simulation.locate_events={}", located)},
               false)};
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

Series adaptive_tolerances(const scenes::Scene& scene, const StudyOptions&) {
  if (scene.model.settings.scheme == engine::Scheme::adaptive) return {};
  Series series{"adaptive", "tolerance", "steps chosen by the program, tolerance tightened", true, false, {}};
  for (int k = 3; k <= 9; ++k)
    series.settings.push_back({fmt::format("tolerance 1e-{} m", k),
                               {"simulation.scheme=adaptive", fmt::format("simulation.adaptive_tolerance=1e-{} m", k)},
                               {},
                               std::pow(10.0, -k),
                               0,
                               false});
  return series;
}

Series solver_tolerances(const scenes::Scene& scene, const StudyOptions&) {
  if (!solver_decides(scene)) return {};
  Series series{kSolverSeries, "tolerance", "the residual at which the contact solver stops", false, false, {}};
  for (int k = 2; k <= 7; ++k)
    series.settings.push_back({fmt::format("solver tolerance 1e-{} m/s", k),
                               {fmt::format("simulation.solver_tolerance=1e-{} m/s", k)},
                               {},
                               std::pow(10.0, -k),
                               0,
                               false});
  series.own_fineness = scene.model.settings.solver_tolerance;
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
    Setting setting{bound > 0 ? fmt::format("mesh within {:g} mm", 1e3 * bound) : "full mesh", {}, {}, bound, 0, false};
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
                               {},
                               1.0 / number,
                               0,
                               false});
  series.own_fineness = 1.0 / own;
  return series;
}

Series recorded_instants(const scenes::Scene& scene, const StudyOptions&) {
  const engine::Settings& s = scene.model.settings;
  Series series{"recorded instants", "interval", "how often the motion is recorded", false, false, {}};
  for (const int k : {16, 8, 4, 2, 1})
    series.settings.push_back(
        {"recorded every " + in_ms(k * s.step), {"simulation.record_interval=" + in_ms(k * s.step)}, {}, k * s.step, 0, false});
  series.own_fineness = study_interval(s);
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
                               {},
                               h,
                               0,
                               false});
  }
  return series;
}

/// The table of series. One that does not mean anything for a scene comes back empty; one whose keys the scene refuses is left out.
constexpr Make kSeries[] = {own_steps,       other_events,        stepping_steps,    rk4_steps,
                            rk4_plain_steps, adaptive_tolerances, solver_tolerances, mesh_details,
                            contact_points,  recorded_instants,   other_contact_law};

}  // namespace

bool solver_decides(const scenes::Scene& scene) {
  const engine::Settings& s = scene.model.settings;
  const bool forces = s.contact_law == engine::ContactLaw::compliant && s.scheme != engine::Scheme::stepping;
  return has_contacts(scene) && !forces;
}

double study_interval(const engine::Settings& s) {
  const double coarsest = kCoarser * s.step;
  return coarsest * std::max(1.0, std::round(s.record_interval / coarsest));
}

std::vector<std::string> runs_with(const Setting& setting) {
  std::vector<std::string> out = setting.overrides;
  out.insert(out.end(), setting.reading.begin(), setting.reading.end());
  return out;
}

std::vector<Series> series_for(const scenes::Scene& scene, const StudyOptions& options, const Accepts& accepts) {
  std::vector<Series> out;
  const std::string interval = "simulation.record_interval=" + in_ms(study_interval(scene.model.settings));
  for (const Make make : kSeries) {
    Series series = make(scene, options);
    if (series.settings.empty()) continue;
    for (Setting& setting : series.settings)
      if (series.varies != "interval") setting.reading.push_back(interval);
    if (accepts(runs_with(series.settings.front()))) out.push_back(std::move(series));
  }
  return out;
}

}  // namespace cli::study
