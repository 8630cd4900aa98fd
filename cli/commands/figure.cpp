// crashreel figure SCENE -o DIR: report figures of one run.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "cli/apart.h"
#include "cli/command.h"
#include "cli/exit.h"
#include "cli/output/json.h"
#include "cli/output/lock.h"
#include "cli/output/whole_file.h"
#include "cli/parse.h"
#include "cli/scene_run.h"
#include "engine/measure/definitions.h"
#include "engine/measure/metrics.h"
#include "engine/measure/phases.h"
#include "engine/measure/vehicle_events.h"
#include "render/figures/figures.h"

namespace cli {
namespace {

struct FigureWish {
  SceneArguments scene;
  std::string output;
  std::string size = "1920x1080";
  std::string quality = "standard";
  bool overwrite = false;
};

/// What the drawings are called, and what they write.
struct Figure {
  const char* name;
  std::vector<std::string> (*draw)(const render::Stage&, const engine::Recording&, const render::FigureJob&);
  bool of_one_person = false;  // one a person who was struck
};
constexpr Figure kFigures[] = {{"site_diagram", render::site_diagram},       {"contact_map", render::contact_map, true},
                               {"time_histories", render::time_histories},   {"vehicle_histories", render::vehicle_histories},
                               {"stroboscopic", render::stroboscopic_still}, {"contact_sheet", render::contact_sheet, true}};

constexpr const char* kExtensions[] = {".pdf", ".svg", ".png"};

bool is_a_figure(const std::string& name) {
  for (const Figure& figure : kFigures)
    for (const std::string extension : kExtensions)
      if (name == figure.name + extension ||
          (figure.of_one_person && name.starts_with(figure.name + std::string("_")) && name.ends_with(extension)))
        return true;
  return false;
}

/// The persons whom figures of one person show, and what their files' names end with: of the first nothing. Those who were struck;
/// where nobody was, the first.
std::vector<std::pair<std::size_t, std::string>> shown_alone(const std::vector<render::PersonFacts>& persons) {
  std::vector<std::pair<std::size_t, std::string>> out;
  for (std::size_t p = 0; p < persons.size(); ++p)
    if (persons[p].hit) out.emplace_back(p, out.empty() ? "" : "_" + persons[p].name);
  if (out.empty()) out.emplace_back(0, "");
  return out;
}

render::PersonFacts facts_of(const engine::Model& model, const engine::Recording& recording, int index,
                             const std::vector<engine::Metric>& metrics) {
  const engine::Person& person = model.persons[static_cast<std::size_t>(index)];
  render::PersonFacts facts;
  facts.name = person.name;
  facts.bodies = person.bodies;
  for (const int b : person.bodies) facts.masses.push_back(model.bodies[static_cast<std::size_t>(b)].mass);
  if (const auto thrown = engine::throw_of_person(model, recording, index)) {
    facts.hit = thrown->hit;
    facts.vehicle_body = thrown->vehicle;
    facts.landed = thrown->landed;
    if (thrown->flew) facts.released = thrown->separated;
    facts.rest = thrown->rest;
    facts.dragged = thrown->dragged;
    for (const engine::ThrowPhase& phase : thrown->phases)
      facts.phases.push_back({phase.name, phase.from, phase.to, phase.distance});
  } else {
    facts.rest = engine::rest_of(model, recording, {index, -1, person.bodies});
  }
  constexpr const char* kShown[] = {"throw_distance_m", "contact_m", "carried_m", "airborne_m",
                                    "fall_m",           "landing_m", "slide_m",   "wrap_around_distance_m"};
  for (const char* key : kShown)
    for (const engine::Metric& m : metrics)
      if (m.key == key && m.object == person.name) facts.dimensions.emplace_back(engine::definition_of(key)->title, m.value);
  return facts;
}

/// What of a delta-v the pair alone did, where others did much of it: who stands between two cars, or is thrown onto another.
std::string of_it_alone(const engine::ImpactSide& side) {
  constexpr double kMost = 0.9;  // [-] of it
  if (side.party.vehicle >= 0 || side.own_delta_v.norm() >= kMost * side.delta_v.norm()) return "";
  return fmt::format(", {} by this pair alone {:.2f}", side.name, side.own_delta_v.norm());
}

/// The first collision phase of every pair; later ones of two that rub against each other would fill the sheet. Then the delta-v of
/// vehicles where no line has it: it is of several phases together, or of a later one. And who was run over.
std::vector<std::string> impact_lines(const engine::Model& model, const engine::Recording& recording,
                                      const std::vector<engine::Metric>& metrics) {
  const std::vector<engine::Impact> impacts = engine::impacts_of(model, recording);
  std::vector<std::string> out;
  std::set<std::pair<std::string, std::string>> told;  // whose, and what [m/s]
  std::size_t later = 0;
  for (const engine::Impact& i : impacts) {
    if (i.phase > 1) {
      ++later;
      continue;
    }
    std::string closing;
    if (std::isfinite(i.closing_speed)) {
      constexpr double kSquare = 1.05;  // [-] less: they meet square
      const bool aslant = i.relative_speed > kSquare * i.closing_speed;
      closing = aslant ? fmt::format("relative {:.2f} m/s, of it closing {:.2f}, ", i.relative_speed, i.closing_speed)
                       : fmt::format("closing {:.2f} m/s, ", i.closing_speed);
    }
    out.push_back(fmt::format("{} / {}  {:.3f} s: {}delta-v {:.2f} / {:.2f} m/s{}{}", i.a.name, i.b.name, i.time, closing,
                              i.a.delta_v.norm(), i.b.delta_v.norm(), of_it_alone(i.a), of_it_alone(i.b)));
    for (const engine::ImpactSide* side : {&i.a, &i.b}) told.emplace(side->name, fmt::format("{:.2f}", side->delta_v.norm()));
  }
  if (later > 0) out.push_back(fmt::format("and {} later {} of the same: impacts.csv", later, later == 1 ? "phase" : "phases"));
  for (int v = 0; v < static_cast<int>(model.vehicles.size()); ++v) {
    const auto event = engine::hardest_event(model, recording, impacts, v);
    if (!event || model.bodies[static_cast<std::size_t>(model.vehicles[static_cast<std::size_t>(v)].body)].fixed) continue;
    const std::string delta_v = fmt::format("{:.2f}", event->delta_v.norm());
    if (event->phases > 1)
      out.push_back(fmt::format("{}: delta-v {} m/s of {} phases together", event->name, delta_v, event->phases));
    else if (!told.contains({event->name, delta_v}))
      out.push_back(fmt::format("{}: delta-v {} m/s in its hardest phase", event->name, delta_v));
  }
  for (const engine::Metric& m : metrics)
    if (m.key == "run_over_s" || m.key == "passed_over_s")
      out.push_back(fmt::format("{}: {} at {:.3f} s", m.object, engine::definition_of(m.key)->title, m.value));
  return out;
}

int draw_figures(const FigureWish& wish) {
  scenes::Scene scene = load_scene(wish.scene);
  render::FigureJob job;
  job.folder = wish.output;
  std::tie(job.width, job.height) = parse_size("--size", wish.size);
  job.quality = wish.quality == "draft"  ? render::Quality::draft
                : wish.quality == "fine" ? render::Quality::fine
                                         : render::Quality::standard;
  job.metadata = {{"title", scene.stage.title},
                  {"version", fmt::format("crashreel {}", CRASHREEL_VERSION)},
                  {"scene", scene.path.filename().string()},
                  {"scene_sha256", scene.sha256}};
  make_writable_folder(job.folder);
  const OutputLock lock(job.folder / "figures", is_a_figure);
  for (const Figure& figure : kFigures)
    for (const char* extension : kExtensions) {
      refuse_existing(job.folder / (std::string(figure.name) + extension), wish.overwrite);
      for (const engine::Person& person : scene.model.persons)
        if (figure.of_one_person)
          refuse_existing(job.folder / (std::string(figure.name) + "_" + person.name + extension), wish.overwrite);
    }

  engine::Recording recording = run_scene(scene, plan_of(scene), wish.scene);
  recording.events = engine::told_events(scene.model, recording);
  if (recording.failure) scene.stage.warnings.push_back(fmt::format("the model diverged at {:.3f} s", recording.failure->time));
  const std::vector<engine::Metric> metrics = engine::measure(scene.model, recording);
  job.impacts = impact_lines(scene.model, recording, metrics);
  for (int p = 0; p < static_cast<int>(scene.model.persons.size()); ++p)
    job.persons.push_back(facts_of(scene.model, recording, p, metrics));

  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  const auto alone = shown_alone(job.persons);
  for (const Figure& figure : kFigures) {
    std::vector<std::string> written;
    for (const auto& [person, name_after] : figure.of_one_person ? alone : std::vector(1, alone.front())) {
      job.person = person;
      job.name_after = figure.of_one_person ? name_after : "";
      for (const std::string& file : apart(figure.name, [&] { return figure.draw(scene.stage, recording, job); }))
        written.push_back(file);
    }
    if (written.empty() && !wish.scene.quiet) fmt::print(stderr, "{}: the run has nothing to show there\n", figure.name);
    for (const std::string& file : written) {
      files.push_back(file);
      if (!wish.scene.json) fmt::print("{}\n", file);
    }
  }
  if (wish.scene.json) fmt::print("{}\n", json_text(Json{{"files", files}}));
  return exit_code_of(recording);
}

}  // namespace

std::function<int()> declare_figure(Arguments& arguments) {
  const auto wish = std::make_shared<FigureWish>();
  declare_scene(arguments, wish->scene);
  declare_progress(arguments, wish->scene);
  arguments.required_option("-o,--output", wish->output, "DIR", "folder for the figures");
  arguments.option("--size", wish->size, "WxH", "pixels of the stills; default 1920x1080");
  arguments.choice("--quality", wish->quality, {"draft", "standard", "fine"}, "looks of the stills against time");
  arguments.flag("--overwrite", wish->overwrite, "replace files that exist");
  return [wish] { return draw_figures(*wish); };
}

}  // namespace cli
