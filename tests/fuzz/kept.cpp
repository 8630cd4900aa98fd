// What the program reads back of its own, and what other programs hand it: their files may be damaged, old or somebody else's.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "cli/exit.h"
#include "cli/inference/driver.h"
#include "cli/inference/ensemble.h"
#include "cli/output/recording_file.h"
#include "cli/study/trial.h"
#include "engine/plan.h"
#include "engine/simulate.h"
#include "engine/start.h"
#include "engine/state.h"
#include "engine/world.h"
#include "scenes/error.h"
#include "scenes/scene.h"
#include "tests/fuzz/targets.h"

namespace fuzz {
namespace {

using engine::Bytes;
using engine::Vec3;

Bytes bytes_of(std::string_view text) {
  return Bytes(text.begin(), text.end());
}

std::string text_of(const Bytes& bytes) {
  return std::string(bytes.begin(), bytes.end());
}

engine::Body round_body(const char* name, double mass, const Vec3& half_axes, const Vec3& at) {
  engine::Body body;
  body.name = name;
  body.mass = mass;
  const engine::HyperEllipsoid shape{half_axes, 2};
  body.shape = shape;
  body.inertia_B = engine::principal_inertia(shape, mass).asDiagonal();
  body.X_WB.p = at;
  return body;
}

/// A bit of everything that a state and a recording keep: a ball that strikes the road, two links on a hinge, a car on its wheels.
engine::Model small_model() {
  engine::Model model;
  model.settings.duration = 0.02;
  model.settings.stop_at_rest = false;
  model.settings.sleep = true;
  model.bodies = {round_body("ball", 2, {0.1, 0.1, 0.1}, {0, 0, 0.1001}), round_body("upper", 1, {0.05, 0.05, 0.3}, {3, 0, 1.5}),
                  round_body("lower", 1, {0.05, 0.05, 0.3}, {3, 0, 0.9}), round_body("car", 1200, {2, 0.8, 0.2}, {10, 0, 0.5})};
  model.bodies[0].V_WB.v = {1, 0, -1};
  model.bodies[3].V_WB.v = {10, 0, 0};
  model.bodies[3].vehicle = 0;
  for (int child : {1, 2}) {
    engine::Joint joint;
    joint.name = child == 1 ? "hook" : "hinge";
    joint.kind = child == 1 ? engine::JointKind::spherical : engine::JointKind::revolute;
    joint.parent = child == 1 ? -1 : 1;
    joint.child = child;
    joint.X_PF.p = child == 1 ? Vec3(3, 0, 1.8) : Vec3(0, 0, -0.3);
    joint.X_CF.p = {0, 0, 0.3};
    model.joints.push_back(joint);
  }
  engine::Vehicle car;
  car.name = "car";
  car.body = 3;
  car.brake = 0.5;
  for (const double x : {1.3, -1.3})
    for (const double y : {0.7, -0.7}) {
      engine::Wheel wheel;
      wheel.hub_B = {x, y, -0.2};
      wheel.steered = x > 0;
      car.wheels.push_back(wheel);
    }
  model.vehicles.push_back(car);
  return model;
}

/// A run of that model, its state at the end, and its first.
struct SmallRun {
  engine::Model model = small_model();
  engine::Plan plan = engine::compile(model);
  engine::State first, last;
  engine::Recording recording;

  SmallRun() {
    engine::World world(model, plan, {});
    first = engine::start(world);
    engine::RunOptions options;
    options.end = &last;
    recording = engine::simulate(model, plan, options);
    demand(!recording.failure && recording.snapshots.size() > 1 && !last.wheels.empty() && !last.contacts.list.empty(),
           "the small model runs, rolls and touches");
  }
};

const SmallRun& small_run() {
  static const SmallRun run;
  return run;
}

/// The same state with the sum of its bytes at the end (FNV-1a): chance does not hit it, and what lies behind would never be read.
Bytes with_sum(std::string_view text) {
  Bytes bytes = bytes_of(text);
  std::uint64_t sum = 0xcbf29ce484222325;
  if (bytes.size() < sizeof sum) return bytes;
  const std::size_t count = bytes.size() - sizeof sum;
  for (std::size_t i = 0; i < count; ++i) sum = (sum ^ bytes[i]) * 0x100000001b3;
  std::memcpy(bytes.data() + count, &sum, sizeof sum);
  return bytes;
}

/// Does what was read give this line again? As text: what is not finite is nothing in JSON, and equals nothing.
bool same(const std::optional<std::pair<std::string, cli::inference::Answer>>& a, const std::string& line) {
  return a && cli::inference::as_line(a->first, a->second) == line;
}

/// The scene that requests are about; its text is read at every request.
const scenes::Scene& asked_scene() {
  static const scenes::Scene scene = scenes::load(std::filesystem::path(file_of(R"(title = "Ball"
[simulation]
duration = "0.64 s"
[[body]]
name = "ball"
mass = "2 kg"
axes = "0.1 0.1 0.1 m"
position = "0 0 0.3 m"
velocity = "1 0 0 m/s"
friction = 0.5
)")));
  return scene;
}

}  // namespace

void request(std::string_view bytes) {
  try {
    const cli::inference::Request found = cli::inference::read_request(asked_scene(), std::string(bytes));
    demand(!found.values.empty(), "a request asks for a run");
    for (std::size_t run = 0; run < found.values.size(); ++run)
      demand(cli::inference::overrides_of(found, run).size() == found.keys.size(), "a value for each key");
  } catch (const cli::UsageError& error) {
    demand(error.what()[0] != '\0', "a refused request says why");
  }
}

void journal(std::string_view bytes) {
  if (const auto found = cli::inference::from_line(std::string(bytes))) {
    const std::string line = cli::inference::as_line(found->first, found->second);
    demand(same(cli::inference::from_line(line), line), "a line that was read can be written and read again");
  }
  cli::study::Outcome trial;
  if (!cli::study::recall(file_of(bytes), trial)) return;
  demand(std::isfinite(trial.end_s) && std::isfinite(trial.instructions), "a trial's figures are numbers");
  for (const double wall : trial.wall_s) demand(std::isfinite(wall), "a trial's times are numbers");
}

std::vector<std::string> written_journal() {
  cli::inference::Answer answer;
  answer.outputs = {{"throw_distance_m", 12.5}, {"delta_v_mps red", std::nan("")}};
  answer.predicted = {std::nullopt, std::vector<double>{1.5, -2e-300}};
  answer.rests = {{"car", {1, 2}}};
  answer.touched = true;
  const std::string line = cli::inference::as_line("body.ball.mass=2 kg", answer);
  demand(same(cli::inference::from_line(line), line), "a line of a journal is read again");
  cli::study::Outcome trial, again;
  trial.quantities = {{"travel_m", 1.5}, {"joint_gap_m", 0}};
  trial.contacts = {"ball ground"};
  trial.wall_s = {0.01, 0.02};
  trial.steps = 640;
  trial.recording = "0123456789abcdef";
  const std::string file = file_of("") + ".json";
  cli::study::store(trial, file);
  demand(cli::study::recall(file, again) && again.steps == trial.steps, "a study's trial is read again");
  std::ifstream in(file, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  std::filesystem::remove(file);
  return {line, text};
}

void state(std::string_view bytes) {
  const Bytes whole = with_sum(bytes);
  const std::optional<engine::State> found = engine::from_bytes(whole, small_run().first);
  if (!found) return;
  demand(found->X_WB.size() == small_run().model.bodies.size(), "a state that was read is of the model");
  const engine::State copy = *found;
  demand(engine::to_bytes(copy) == whole, "a state that was read is written as it was");
}

std::vector<std::string> written_state() {
  std::vector<std::string> out;
  for (const engine::State* state : {&small_run().first, &small_run().last}) {
    const Bytes bytes = engine::to_bytes(*state);
    demand(with_sum(text_of(bytes)) == bytes, "a state ends with the sum of its bytes");
    demand(engine::from_bytes(bytes, small_run().first).has_value(), "a state that was written is read");
    out.push_back(text_of(bytes));
  }
  return out;
}

void recording(std::string_view bytes) {
  const auto found = cli::recording_of(bytes_of(bytes), small_run().model);
  if (!found) return;
  const Bytes payload = cli::payload_of(*found);
  const auto again = cli::recording_of(payload, small_run().model);
  demand(again && cli::payload_of(*again) == payload, "a recording that was read can be written and read again");
}

std::vector<std::string> written_recording() {
  const Bytes payload = cli::payload_of(small_run().recording);
  demand(cli::recording_of(payload, small_run().model).has_value(), "a recording that was written is read");
  return {text_of(payload)};
}

}  // namespace fuzz
