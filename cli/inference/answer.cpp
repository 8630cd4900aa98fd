// One run of an ensemble, and its line in the journal.
#include <fmt/format.h>

#include <limits>

#include "cli/inference/ensemble.h"
#include "cli/inference/observe.h"
#include "cli/output/json.h"
#include "cli/scene_run.h"
#include "cli/study/quantities.h"
#include "engine/measure/impacts.h"
#include "engine/plan.h"
#include "engine/simulate.h"

namespace cli::inference {
namespace {

bool is_meeting(const engine::Event& event) {
  return event.kind == "first_contact" || event.kind == "impact" || event.kind == "collision";
}

Json numbers_json(const std::vector<double>& numbers) {
  Json out = Json::array();
  for (const double x : numbers) out.push_back(number_json(x));
  return out;
}

double number_of(const Json& json) {
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace

Answer answer(const scenes::Scene& scene, const std::vector<std::string>& overrides) {
  Answer out;
  try {
    const scenes::Scene variant = scenes::variant(scene, overrides);
    const engine::Recording recording = engine::simulate(variant.model, engine::compile(variant.model));
    if (const auto& failure = recording.failure) {
      out.status = fmt::format("diverged at {:.4f} s, body {}: {}", failure->time, failure->body, failure->message);
      return out;
    }
    const std::vector<engine::Metric> metrics = engine::measure(variant.model, recording);
    for (const study::Quantity& q : study::quantities_of(variant.model, recording, metrics)) {
      out.outputs[q.name] = q.value;
      if (q.so_far) out.notes.so_far.push_back(q.name);
    }
    out.notes.warnings = warnings_of(variant, recording);
    for (const scenes::Evidence& e : scene.inference.evidence)
      out.predicted.push_back(observe(e, variant.model, recording, metrics));
    out.rests = rest_places(variant.model, recording, metrics);
    const std::vector<engine::Event> events = engine::told_events(variant.model, recording);
    out.touched = std::any_of(events.begin(), events.end(), is_meeting);
  } catch (const scenes::SceneErrors& error) {
    out.status = "refused: " + first_line(error.what());
  }
  return out;
}

std::string as_line(const std::string& name, const Answer& a) {
  Json json = {{"run", name}, {"status", a.status}, {"touched", a.touched}, {"out", Json::object()}, {"predicted", Json::array()}};
  for (const auto& [key, value] : a.outputs) json["out"][key] = number_json(value);
  if (!a.rests.empty()) json["rests"] = a.rests;
  if (!a.notes.so_far.empty()) json["so_far"] = a.notes.so_far;
  if (!a.notes.warnings.empty()) json["warnings"] = a.notes.warnings;
  for (const auto& p : a.predicted) json["predicted"].push_back(p ? numbers_json(*p) : Json(nullptr));
  return json_text(json, -1) + "\n";
}

std::optional<std::pair<std::string, Answer>> from_line(const std::string& line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  try {
    Answer out;
    out.status = json.at("status").get<std::string>();
    out.touched = json.at("touched").get<bool>();
    for (const auto& [key, value] : json.at("out").get_ref<const Json::object_t&>()) out.outputs[key] = number_of(value);
    const auto read = [&json](const char* key, auto& into) {
      if (const auto found = json.find(key); found != json.end()) found->get_to(into);
    };
    read("rests", out.rests);
    read("so_far", out.notes.so_far);
    read("warnings", out.notes.warnings);
    for (const Json& p : json.at("predicted").get_ref<const Json::array_t&>()) {
      if (p.is_null()) {
        out.predicted.emplace_back();
        continue;
      }
      std::vector<double> numbers;
      for (const Json& x : p.get_ref<const Json::array_t&>()) numbers.push_back(number_of(x));
      out.predicted.emplace_back(std::move(numbers));
    }
    return std::pair(json.at("run").get<std::string>(), std::move(out));
  } catch (const Json::exception&) {
    return std::nullopt;  // a value is missing or of another kind: no line of ours
  }
}

}  // namespace cli::inference
