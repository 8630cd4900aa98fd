// [[camera]], [[shot]], [[card]]: from where and in which order the scene is filmed.
#include <fmt/format.h>

#include <algorithm>

#include "engine/math/functions.h"
#include "scenes/loader/builder.h"

namespace scenes {
namespace {

constexpr double kFilmHeight = 0.024;  // [m] of the 35 mm still format that focal lengths are spoken of in

struct Lens {
  std::optional<double> focal_length;  // [m] in place of the angle of view
};

const Key kKnotKeys[] = {
    bound<&render::CameraKnot::time>({"time", Type::number, Dimension::time, kRequired, "When the camera is there.", kNotNegative}),
    bound<&render::CameraKnot::position>(
        {"position", Type::vector3, Dimension::length, kRequired, "Where it is; with follow: offset from the subject."}),
    bound<&render::CameraKnot::target>(
        {"target", Type::vector3, Dimension::length, kRequired, "The point looked at; with follow: offset from the subject."}),
};
const Section kKnotSection{"camera.knot", "[[camera.knot]]",
                           "A moving camera's place at one time; between knots it runs along a smooth curve.", kKnotKeys};

const Key kCameraKeys[] = {
    bound<&render::Camera::name>({"name", Type::text, Dimension::none, kRequired, "Name for --camera and for shots."}),
    bound<&render::Camera::kind>({"kind", Type::choice, Dimension::none, "'fixed'",
                                  "Stands still; keeps its offset; circles; looks straight down; sees with a driver or a person, "
                                  "whose eye backs off from what the face is pressed against; or moves along knots.",
                                  kAny, "fixed|follow|orbit|top|eye|path"}),
    bound<&render::Camera::position>(
        {"position", Type::vector3, Dimension::length, "'-8 -8 3 m'",
         "Fixed: in the world. Follow: offset from the subject. Eye: in the axes of the body that carries it, a person's head, "
         "a vehicle."}),
    bound<&render::Camera::target>(
        {"target", Type::vector3, Dimension::length, "'0 0 1 m'",
         "Fixed: point looked at. Eye: the same in the axes of its carrier. Others: offset from the subject."}),
    bound<&render::Camera::follow>(
        {"follow", Type::text, Dimension::none, "''", "The subject: a body, a vehicle or a person. Empty: the world."}),
    bound<&render::Camera::vertical_fov>(
        {"fov", Type::number, Dimension::angle, "'40 deg'", "Vertical angle of view.", between(0.02, 2.6)}),
    bound<&Lens::focal_length>({"lens",
                                Type::number,
                                Dimension::length,
                                "",
                                "Focal length in place of fov, for a picture 24 mm high (35 mm still format): \"50 mm\".",
                                between(0.006, 1),
                                {},
                                nullptr,
                                {},
                                between(0.006, 0.25)}),
    bound<&render::Camera::orbit_radius>({"radius", Type::number, Dimension::length, "'8 m'", "Orbit: distance.", kPositive}),
    bound<&render::Camera::orbit_height>({"height", Type::number, Dimension::length, "'2.5 m'", "Orbit: above the subject."}),
    bound<&render::Camera::orbit_start>(
        {"start", Type::number, Dimension::angle, "'0 deg'", "Orbit: where it begins, from +x towards +y."}),
    bound<&render::Camera::orbit_rate>({"rate", Type::number, Dimension::angular_speed, "'0.3 rad/s'", "Orbit: how fast."}),
    bound<&render::Camera::top_height>({"span", Type::number, Dimension::length, "'14 m'",
                                        "Top: metres from the lower to the upper edge of the picture.", kPositive}),
    bound<&render::Camera::smoothing>({"smoothing", Type::number, Dimension::time, "'0.25 s'",
                                       "A following camera averages its subject over this time.", kNotNegative}),
    {"knot", Type::tables, Dimension::none, "", "Path: where it is when, at least two.", kAny, {}, &kKnotSection},
};

const Key kShotKeys[] = {
    bound<&render::Shot::camera>({"camera", Type::text, Dimension::none, kRequired, "The camera's name."}),
    bound<&render::Shot::from>({"from", Type::number, Dimension::time, "'0 s'", "Simulated time at its start.", kNotNegative}),
    bound<&render::Shot::to>(
        {"to", Type::number, Dimension::time, "", "Simulated time at its end; left out: the end of the run.", kNotNegative}),
    bound<&render::Shot::speed>(
        {"speed", Type::number, Dimension::none, "1", "0.25 is four times slow motion, 0 freezes for hold.", kNotNegative}),
    bound<&render::Shot::hold>(
        {"hold", Type::number, Dimension::time, "'0 s'", "How long a frozen picture stays.", between(0, kLongestHold)}),
    bound<&render::Shot::layout>(
        {"layout", Type::choice, Dimension::none, "'single'",
         "One camera; two side by side; two above each other; or the second small in a corner of the first. One clock for both.",
         kAny, "single|split|stacked|inset"}),
    bound<&render::Shot::second>({"second", Type::text, Dimension::none, "''", "The other camera of a shared picture."}),
    bound<&render::Shot::title>(
        {"title", Type::text, Dimension::none, "''", "Chapter in the video file; left out: the camera's name."}),
};

const Key kCardKeys[] = {
    bound<&render::Card::title>({"title", Type::text, Dimension::none, kRequired, "Its heading."}),
    bound<&render::Card::lines>({"lines", Type::texts, Dimension::none, "[]", "What stands below: assumptions, sources, results."}),
    bound<&render::Card::hold>(
        {"hold", Type::number, Dimension::time, "'3 s'", "How long it stays.", Range{0, kLongestHold, true}}),
    bound<&render::Card::at_end>(
        {"place", Type::choice, Dimension::none, "'start'", "Before the first shot or after the last.", kAny, "start|end"}),
};

bool subject_exists(const Builder& builder, const std::string& name) {
  const engine::Model& model = builder.scene.model;
  if (builder.is_declared(name) && name.find('/') == std::string::npos) return true;
  return builder.body_index(name) >= 0 ||
         std::any_of(model.persons.begin(), model.persons.end(), [&](const auto& p) { return p.name == name; }) ||
         std::any_of(model.vehicles.begin(), model.vehicles.end(), [&](const auto& v) { return v.name == name; });
}

void read_knots(Reader& r, render::Camera& camera) {
  for (Reader& knot : r.tables("knot")) {
    knot.fill(camera.path.emplace_back());
    if (camera.path.size() > 1 && camera.path.back().time <= camera.path[camera.path.size() - 2].time)
      knot.fail("time", "must be later than that of the knot before it");
    if ((camera.path.back().position - camera.path.back().target).norm() < 1e-6)
      knot.fail("target", "must differ from position; a camera needs a direction");
  }
  const bool path = camera.kind == render::CameraKind::path;
  if (path && camera.path.size() < 2) r.fail("kind", "needs two knots or more, each under [[camera.knot]]");
  if (!path && !camera.path.empty()) r.fail("kind", "has no use for knots; a camera with knots is of kind \"path\"");
}

void read_camera(Builder& builder, Reader& r) {
  render::Camera camera;
  Lens lens;
  r.fill(camera);
  r.fill(lens);
  for (const render::Camera& other : builder.scene.stage.cameras)
    if (other.name == camera.name) r.fail("name", "this name is already used; every camera needs a name of its own");
  if (!camera.follow.empty() && !subject_exists(builder, camera.follow)) {
    std::vector<std::string> names = builder.body_names();
    for (const auto& person : builder.scene.model.persons) names.push_back(person.name);
    const std::string guess = nearest(camera.follow, names);
    r.fail("follow", guess.empty() ? "is no body, vehicle or person of the scene"
                                   : fmt::format("is no body, vehicle or person of the scene; did you mean \"{}\"?", guess));
  }
  if (lens.focal_length) camera.vertical_fov = 2 * engine::math::atan(kFilmHeight / 2 / *lens.focal_length);
  if (r.has("lens") && r.has("fov")) r.fail("lens", "says the same as fov; give one of them");
  const bool straight = camera.kind == render::CameraKind::fixed || camera.kind == render::CameraKind::eye;
  if (straight && (camera.position - camera.target).norm() < 1e-6) {
    r.fail("target", "must differ from position; a camera needs a direction");
  }
  read_knots(r, camera);
  builder.scene.stage.cameras.push_back(std::move(camera));
}

}  // namespace

void check_camera_name(Builder& builder, Reader& r, const std::string& name, std::string_view key) {
  std::vector<std::string> names;
  for (const render::Camera& camera : builder.scene.stage.cameras) names.push_back(camera.name);
  if (!r.has(key) || std::find(names.begin(), names.end(), name) != names.end()) return;  // what is missing has been told
  const std::string guess = nearest(name, names);
  r.fail(key, guess.empty() ? fmt::format("is no camera of the scene; it has {}", fmt::join(names, ", "))
                            : fmt::format("is no camera of the scene; did you mean \"{}\"?", guess));
}

namespace {

void read_shot(Builder& builder, Reader& r) {
  render::Shot shot;
  r.fill(shot);
  check_camera_name(builder, r, shot.camera, "camera");
  if (!r.has("to")) shot.to = std::max(shot.from, builder.scene.model.settings.duration);
  if (shot.to < shot.from) r.fail("to", "must not be earlier than from");
  if (shot.speed == 0 && shot.hold == 0)
    r.fail("hold", "must be greater than 0 s where speed is 0; a frozen picture needs a duration");
  const bool shared = shot.layout != render::Layout::single;
  if (!shot.second.empty()) check_camera_name(builder, r, shot.second, "second");
  if (shared && shot.second.empty()) r.fail("layout", "shares the picture between two cameras; name the other as second");
  if (!shared && !shot.second.empty()) r.fail("second", "needs a layout: split, stacked or inset");
  builder.scene.stage.shots.push_back(shot);
}

/// Looks at the middle of everything that can move, from far enough to see all of it.
render::Camera overview(const engine::Model& model) {
  engine::Vec3 lower = engine::Vec3::Constant(1e300);
  engine::Vec3 upper = -lower;
  for (const engine::Body& body : model.bodies) {
    lower = lower.cwiseMin(body.X_WB.p);
    upper = upper.cwiseMax(body.X_WB.p);
  }
  if (model.bodies.empty()) lower = upper = engine::Vec3::Zero();
  const engine::Vec3 middle = (lower + upper) / 2;
  const double distance = 4 + 1.6 * (upper - lower).norm();
  render::Camera camera;
  camera.name = "overview";
  camera.target = middle;
  camera.position = middle + distance * engine::Vec3(-0.5, -0.8, 0.33);
  return camera;
}

}  // namespace

const Section kCameraSection{"camera", "[[camera]]",
                             "A camera. A scene without one gets \"overview\", which looks at where things are at the start.",
                             kCameraKeys};
const Section kShotSection{"shot", "[[shot]]",
                           "A stretch of film. Without shots: the whole run from the first camera at natural speed.", kShotKeys};
const Section kCardSection{"card", "[[card]]", "A page of text in the film: title, assumptions, results.", kCardKeys};

void read_cameras(Builder& builder, Reader& scene) {
  render::Stage& stage = builder.scene.stage;
  for (Reader& camera : scene.tables("camera")) read_camera(builder, camera);
  if (stage.cameras.empty()) stage.cameras.push_back(overview(builder.scene.model));
  for (Reader& shot : scene.tables("shot")) read_shot(builder, shot);
  for (Reader& card : scene.tables("card")) card.fill(stage.cards.emplace_back());
}

}  // namespace scenes
