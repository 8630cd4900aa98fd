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

/// What a view keeps to.
std::string subject_of(const engine::Model& model) {
  for (const engine::Person& person : model.persons)
    if (person.mount < 0) return person.name;
  if (!model.vehicles.empty()) return model.vehicles.front().name;
  return model.bodies.front().name;
}

/// The way things go: that of the first vehicle, else +x.
Vec3 heading_of(const engine::Model& model) {
  if (model.vehicles.empty()) return Vec3::UnitX();
  Vec3 ahead = model.bodies[static_cast<std::size_t>(model.vehicles.front().body)].X_WB.q * Vec3::UnitX();
  ahead.z() = 0;
  return ahead.norm() > 1e-6 ? Vec3(ahead.normalized()) : Vec3::UnitX();
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

/// The eye of a driver on the left, from the centre of mass; the bonnet stays in the picture's foot.
render::Camera out_of_vehicle(const engine::Model& model) {
  if (model.vehicles.empty()) throw UsageError("--camera driver needs a vehicle; the scene has none");
  const engine::Vehicle& vehicle = model.vehicles.front();
  render::Camera camera;
  camera.kind = render::CameraKind::eye;
  camera.follow = vehicle.name;
  const auto* shape = std::get_if<engine::MeshShape>(&model.bodies[static_cast<std::size_t>(vehicle.body)].shape);
  const double roof = shape ? shape->mesh->bounds().upper.z() + shape->X_BM.p.z() : 0.9;
  const double nose = shape ? shape->mesh->bounds().upper.x() + shape->X_BM.p.x() : 2;
  camera.position = {nose - 1.75, 0.36, roof - 0.28};
  camera.target = camera.position + Vec3(10, 0, -0.5);
  camera.vertical_fov = 0.8;
  return camera;
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
  if (name == "follow") camera = following(model, -9 * ahead + 2 * right + 3 * up);
  if (name == "driver") camera = out_of_vehicle(model);
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
