#include "cli/study/trial.h"

#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli/exit.h"
#include "cli/output/json.h"
#include "cli/output/whole_file.h"
#include "cli/progress.h"
#include "cli/study/instructions.h"
#include "cli/study/perturb.h"
#include "engine/plan.h"
#include "engine/simulate.h"
#include "scenes/loader/sha256.h"

namespace cli::study {
namespace {

constexpr double kEnough = 0.4;      // [s] of measuring one trial; a long run is repeated by its ensemble
constexpr int kMostRepetitions = 7;  // more do not move a median
constexpr double kLong = 0.25;       // [s] a run this long has warmed up within itself

}  // namespace

std::string fingerprint_of(const Trial& trial, const scenes::Scene& scene, const std::string& program) {
  return scenes::sha256(
      fmt::format("{} {} {} {}{}", scene.sha256, scene.assets_sha256, program, trial.member, trial.timed ? "" : " once"));
}

Outcome run(const Trial& trial) {
  scenes::Scene scene = scenes::load(trial.scene, trial.overrides, trial.meshes);
  if (trial.assets != scene.assets_sha256)
    throw MachineError(fmt::format("a file that {} names was changed while the study ran", trial.scene.path.string()));
  if (trial.member < 0)
    start_elsewhere(scene.model, -trial.member);
  else
    perturb(scene.model, trial.member);
  const engine::Plan plan = engine::compile(scene.model);
  InstructionCounter counter;
  Outcome out;
  engine::Recording recording;
  double spent = 0;
  for (int i = 0; i <= kMostRepetitions; ++i) {
    counter.start();
    const double begin = computed_seconds();
    recording = engine::simulate(scene.model, plan);
    const double wall = computed_seconds() - begin;
    out.instructions = counter.stop();
    spent += wall;
    // the first run of a short trial warms the caches
    if (i > 0 || wall > kLong || !trial.timed) out.wall_s.push_back(wall);
    if (out.wall_s.size() >= 3 && spent > kEnough) break;
    if (wall > kLong || !trial.timed) break;
  }
  out.steps = recording.steps + recording.diagnostics.substeps;
  out.end_s = recording.end_time();
  if (recording.failure)
    out.failure = fmt::format("diverged at {:.4f} s, body {}", recording.failure->time, recording.failure->body);
  out.recording = fmt::format("{:016x}", engine::hash(recording));
  out.quantities = quantities_of(scene.model, recording);
  out.contacts = contact_sequence(recording);
  return out;
}

void store(const Outcome& outcome, const std::filesystem::path& file) {
  nlohmann::ordered_json json;
  json["schema"] = 1;
  for (const Quantity& q : outcome.quantities) json["quantities"].push_back({q.name, q.value, q.so_far});
  json["contacts"] = outcome.contacts;
  json["wall_s"] = outcome.wall_s;
  json["instructions"] = outcome.instructions;
  json["steps"] = outcome.steps;
  json["end_s"] = outcome.end_s;
  json["failure"] = outcome.failure;
  json["recording"] = outcome.recording;
  WholeFile whole(file);
  whole.write(json_text(json, -1) + "\n");
  whole.close();
  whole.publish();
}

bool recall(const std::filesystem::path& file, Outcome& outcome) {
  std::ifstream in(file);
  const auto json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object()) return false;
  try {
    Outcome read;
    for (const auto& q : json.at("quantities"))
      read.quantities.push_back({q.at(0).get<std::string>(),
                                 q.at(1).is_number() ? q.at(1).get<double>() : std::numeric_limits<double>::quiet_NaN(),
                                 q.at(2).get<bool>()});
    read.contacts = json.at("contacts").get<std::vector<std::string>>();
    read.wall_s = json.at("wall_s").get<std::vector<double>>();
    read.instructions = json.at("instructions").get<double>();
    if (!json.at("steps").is_number_integer()) return false;
    read.steps = json.at("steps").get<long>();
    read.end_s = json.at("end_s").get<double>();
    read.failure = json.at("failure").get<std::string>();
    read.recording = json.at("recording").get<std::string>();
    outcome = std::move(read);
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;  // a value is missing or of another kind: no trial of ours
  }
}

}  // namespace cli::study
