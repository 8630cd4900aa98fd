#include "cli/camera_presets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "cli/exit.h"
#include "scenes/loader/quantity.h"

namespace cli {
namespace {

using engine::Vec3;

constexpr double kFilmHeight = 0.024;  // [m] of the 36 x 24 mm film that focal lengths are told for

/// A person on foot; null: none.
const engine::Person* walker_of(const engine::Model& model) {
  for (const engine::Person& person : model.persons)
    if (person.mount < 0) return &person;
  return nullptr;
}

/// The person looked at: one on foot before one who rides; null: none.
const engine::Person* watched_of(const engine::Model& model) {
  const engine::Person* walker = walker_of(model);
  return walker || model.persons.empty() ? walker : &model.persons.front();
}

const engine::Body& body_of(const engine::Model& model, int body) {
  return model.bodies[static_cast<std::size_t>(body)];
}

/// The vehicle that drives towards the person on foot the fastest at the start; where none does, the fastest. Null: no vehicle.
const engine::Vehicle* leading_vehicle(const engine::Model& model) {
  const engine::Person* walker = walker_of(model);
  const engine::Vehicle *nearing = nullptr, *fastest = nullptr;
  double most_nearing = 0, most = -1;  // [m/s]
  for (const engine::Vehicle& vehicle : model.vehicles) {
    const engine::Body& body = body_of(model, vehicle.body);
    const Vec3 way = walker ? Vec3(body_of(model, walker->hips).X_WB.p - body.X_WB.p) : Vec3(Vec3::Zero());
    const double closing = way.norm() > 0 ? body.V_WB.v.dot(way.normalized()) : 0;
    if (closing > most_nearing) nearing = &vehicle, most_nearing = closing;
    if (body.V_WB.v.norm() > most) fastest = &vehicle, most = body.V_WB.v.norm();
  }
  return nearing ? nearing : fastest;
}

/// What a view keeps to.
std::string subject_of(const engine::Model& model) {
  if (const engine::Person* person = watched_of(model)) return person->name;
  if (const engine::Vehicle* vehicle = leading_vehicle(model)) return vehicle->name;
  return model.bodies.front().name;
}

Vec3 level(const Vec3& direction) {
  const Vec3 flat(direction.x(), direction.y(), 0);
  return flat.norm() > 1e-6 ? Vec3(flat.normalized()) : Vec3(Vec3::UnitX());
}

/// The way things go: that of the leading vehicle, else +x.
Vec3 heading_of(const engine::Model& model) {
  const engine::Vehicle* vehicle = leading_vehicle(model);
  return vehicle ? level(body_of(model, vehicle->body).X_WB.q * Vec3::UnitX()) : Vec3(Vec3::UnitX());
}

render::Camera following(const engine::Model& model, const Vec3& offset) {
  render::Camera camera;
  camera.kind = render::CameraKind::follow;
  camera.follow = subject_of(model);
  camera.position = offset;
  camera.target = Vec3::Zero();
  return camera;
}

render::Camera from_above(const engine::Model& model) {
  render::Camera camera = following(model, Vec3::Zero());
  camera.kind = render::CameraKind::top;
  camera.top_height = 20;
  return camera;
}

constexpr double kBehind = 5, kBeside = 7.5, kUp = 3;  // [m] of the camera that follows

/// 1: left of the way, -1: right. The side on which a person stands to the vehicle when they meet, unless others stand between
/// there, as parked cars do.
double free_side(const engine::Model& model, const engine::Person& watched, const engine::Vehicle& vehicle) {
  constexpr double kNose = 2;  // [m] ahead of the centre of mass
  const engine::Body &person = body_of(model, watched.hips), &car = body_of(model, vehicle.body);
  const Vec3 ahead = heading_of(model), left(-ahead.y(), ahead.x(), 0);
  const Vec3 p = person.X_WB.p - car.X_WB.p, v = person.V_WB.v - car.V_WB.v;
  const double closing = -v.dot(ahead), meet = closing > 0 ? std::max(p.dot(ahead) - kNose, 0.0) / closing : 0;  // [m/s], [s]
  const double side = (p + meet * v).dot(left) > 0 ? 1 : -1;
  int there = 0, across = 0;
  for (const engine::Vehicle& other : model.vehicles) {
    if (&other == &vehicle || other.body == watched.mount) continue;
    const Vec3 from_person = body_of(model, other.body).X_WB.p - person.X_WB.p;
    const double beside = side * from_person.dot(left);
    if (std::abs(beside) < kBeside && std::abs(from_person.dot(ahead)) < 2 * kBehind) ++(beside > 0 ? there : across);
  }
  return there > across ? -side : side;
}

/// Goes along behind and to the side: square behind the vehicle its own body would hide the person it strikes.
render::Camera from_behind(const engine::Model& model) {
  const Vec3 ahead = heading_of(model), left(-ahead.y(), ahead.x(), 0);
  const engine::Person* watched = watched_of(model);
  const engine::Vehicle* vehicle = leading_vehicle(model);
  const double side = watched && vehicle ? free_side(model, *watched, *vehicle) : -1;
  return following(model, -kBehind * ahead + side * kBeside * left + kUp * Vec3::UnitZ());
}

/// An eye of a body, from its centre of mass, that looks level ahead and a little down at the start. `ahead` in body axes.
render::Camera looking_out(const std::string& carrier, const Vec3& eye_B, const Vec3& ahead_B, const Vec3& up_B) {
  render::Camera camera;
  camera.kind = render::CameraKind::eye;
  camera.follow = carrier;
  camera.position = eye_B;
  camera.target = eye_B + 10 * ahead_B - 0.5 * up_B;
  camera.vertical_fov = 0.8;
  return camera;
}

/// A rider's, just before the face.
render::Camera out_of_head(const engine::Model& model, const engine::Person& rider, const Vec3& ahead) {
  constexpr double kForward = 0.16, kHigher = 0.04;  // [m] from the centre of the head
  const engine::Quat q_BW = body_of(model, rider.head).X_WB.q.conjugate();
  return looking_out(rider.name, q_BW * (kForward * ahead + kHigher * Vec3::UnitZ()), q_BW * ahead, q_BW * Vec3::UnitZ());
}

/// The eye of a driver on the left as the vehicle's file gives it, else by the usual distances to nose and roof.
Vec3 driver_eye(const scenes::Scene& scene, const engine::Vehicle& vehicle) {
  if (const auto given = scene.stage.eyes.find(vehicle.body); given != scene.stage.eyes.end()) return given->second;
  const auto* shape = std::get_if<engine::MeshShape>(&body_of(scene.model, vehicle.body).shape);
  const double roof = shape ? shape->mesh->bounds().upper.z() + shape->X_BM.p.z() : 0.9;
  const double nose = shape ? shape->mesh->bounds().upper.x() + shape->X_BM.p.x() : 2;
  return {nose - 1.75, 0.36, roof - 0.28};
}

render::Camera out_of_vehicle(const scenes::Scene& scene) {
  const engine::Model& model = scene.model;
  const engine::Vehicle* vehicle = leading_vehicle(model);
  if (!vehicle) throw UsageError("--camera driver needs a vehicle; the scene has none");
  for (const engine::Person& person : model.persons)
    if (person.mount == vehicle->body && person.head >= 0) return out_of_head(model, person, heading_of(model));
  return looking_out(vehicle->name, driver_eye(scene, *vehicle), Vec3::UnitX(), Vec3::UnitZ());
}

Vec3 place_of(const char* option, const std::string& text) {
  const scenes::Quantities read = scenes::parse_quantities(text, scenes::Dimension::length);
  if (!read.problem.empty()) throw UsageError(fmt::format("{} is \"{}\": {}", option, text, read.problem));
  if (read.values.size() != 3)
    throw UsageError(fmt::format("{} is \"{}\": must be three lengths, like \"6 -9 2 m\"", option, text));
  return {read.values[0], read.values[1], read.values[2]};
}

Vec3 middle_of(const engine::Model& model) {
  Vec3 lower = Vec3::Constant(1e300), upper = -lower;
  for (const engine::Body& body : model.bodies) {
    lower = lower.cwiseMin(body.X_WB.p);
    upper = upper.cwiseMax(body.X_WB.p);
  }
  return (lower + upper) / 2;
}

}  // namespace

std::vector<std::string> preset_names() {
  return {"top", "side", "front", "driver", "follow"};
}

std::optional<render::Camera> preset_camera(const std::string& name, const scenes::Scene& scene) {
  const engine::Model& model = scene.model;
  const Vec3 ahead = heading_of(model), right(ahead.y(), -ahead.x(), 0), up = Vec3::UnitZ();
  std::optional<render::Camera> camera;
  if (name == "top") camera = from_above(model);
  if (name == "side") camera = following(model, 10 * right + 1.2 * up);
  if (name == "front") camera = following(model, 9 * ahead + 1.5 * right + 1.4 * up);
  if (name == "follow") camera = from_behind(model);
  if (name == "driver") camera = out_of_vehicle(scene);
  if (camera) camera->name = name;
  return camera;
}

render::Camera camera_at(const std::string& name, const std::string& eye, const std::string& look_at, const std::string& lens,
                         const scenes::Scene& scene) {
  render::Camera camera;
  camera.name = name;
  camera.position = place_of("--eye", eye);
  camera.target = look_at.empty() ? middle_of(scene.model) : place_of("--look-at", look_at);
  if ((camera.position - camera.target).norm() < 1e-6)
    throw UsageError("--eye and --look-at are one place; a camera needs a direction");
  if (!lens.empty()) {
    const scenes::Quantity length = scenes::parse_quantity(lens, scenes::Dimension::length);
    if (!length.problem.empty()) throw UsageError(fmt::format("--lens is \"{}\": {}", lens, length.problem));
    if (length.value < 0.004 || length.value > 2) throw UsageError(fmt::format("--lens is \"{}\": must lie in 4..2000 mm", lens));
    camera.vertical_fov = 2 * std::atan(kFilmHeight / 2 / length.value);
  }
  return camera;
}

}  // namespace cli
