// What the scene looks like and how it is filmed: [[camera]], [[shot]], [overlays], [output], [road], [sky].
#include <fmt/format.h>

#include <algorithm>

#include "scenes/loader/builder.h"

namespace scenes {
namespace {

const Key kCameraKeys[] = {
    {"name", Type::text, Dimension::none, kRequired, "Name for --camera and for shots."},
    {"kind", Type::choice, Dimension::none, "'fixed'", "Stands still; keeps its offset; circles; or looks straight down.", kAny,
     "fixed|follow|orbit|top"},
    {"position", Type::vector3, Dimension::length, "'-8 -8 3 m'", "Fixed: in the world. Follow: offset from the subject."},
    {"target", Type::vector3, Dimension::length, "'0 0 1 m'", "Fixed: point looked at. Others: offset from the subject."},
    {"follow", Type::text, Dimension::none, "''", "The subject: a body, a vehicle or a person. Empty: the world."},
    {"fov", Type::number, Dimension::angle, "'40 deg'", "Vertical angle of view.", between(0.02, 2.6)},
    {"radius", Type::number, Dimension::length, "'8 m'", "Orbit: distance.", kPositive},
    {"height", Type::number, Dimension::length, "'2.5 m'", "Orbit: above the subject."},
    {"start", Type::number, Dimension::angle, "'0 deg'", "Orbit: where it begins, from +x towards +y."},
    {"rate", Type::number, Dimension::angular_speed, "'0.3 rad/s'", "Orbit: how fast."},
    {"span", Type::number, Dimension::length, "'14 m'", "Top: metres from the lower to the upper edge of the picture.", kPositive},
    {"smoothing", Type::number, Dimension::time, "'0.25 s'", "A following camera averages its subject over this time.",
     kNotNegative},
};

const Key kShotKeys[] = {
    {"camera", Type::text, Dimension::none, kRequired, "The camera's name."},
    {"from", Type::number, Dimension::time, "'0 s'", "Simulated time at its start.", kNotNegative},
    {"to", Type::number, Dimension::time, "", "Simulated time at its end; left out: the end of the run.", kNotNegative},
    {"speed", Type::number, Dimension::none, "1", "0.25 is four times slow motion, 0 freezes for hold.", kNotNegative},
    {"hold", Type::number, Dimension::time, "'0 s'", "How long a frozen picture stays.", kNotNegative},
};

const Key kOverlayKeys[] = {
    {"contacts", Type::boolean, Dimension::none, "true", "Contact points and normals."},
    {"forces", Type::boolean, Dimension::none, "true", "Arrows, long by force."},
    {"caption", Type::boolean, Dimension::none, "true", "Time, speeds, camera."},
    {"traces", Type::boolean, Dimension::none, "false", "Paths of the bodies in trace_bodies."},
    {"trace_bodies", Type::texts, Dimension::none, "[]", "Bodies whose paths are drawn; empty: head and hips of every person."},
    {"disclaimer", Type::boolean, Dimension::none, "true", "\"Simulation, not footage\" and the provenance at the foot."},
    {"scale_bar", Type::boolean, Dimension::none, "true", "A bar of metres in top views."},
    {"force_scale", Type::number, Dimension::stiffness, "'10 kN/m'", "Force that one metre of arrow stands for.", kPositive},
};

const Key kStillKeys[] = {
    {"time", Type::number, Dimension::time, kRequired, "Simulated time.", kNotNegative},
    {"camera", Type::text, Dimension::none, "''", "Camera; left out: that of the shot at this time."},
};
const Section kStillSection{"output.still", "[[output.still]]", "Stills a snapshot test draws.", kStillKeys};

const Key kOutputKeys[] = {
    {"width", Type::integer, Dimension::none, "1280", "Picture width in pixels, even.", between(16, 8192)},
    {"height", Type::integer, Dimension::none, "720", "Picture height in pixels, even.", between(16, 8192)},
    {"fps", Type::number, Dimension::none, "30", "Frames a second.", between(1, 1000)},
    {"quality", Type::choice, Dimension::none, "'standard'", "Effort a frame.", kAny, "draft|standard|fine"},
    {"still", Type::tables, Dimension::none, "", "Stills for snapshot tests.", kAny, {}, &kStillSection},
};

const Key kRoadKeys[] = {
    {"kind", Type::choice, Dimension::none, "'plain'", "Asphalt with lane markings along x, or plain ground with a metre grid.",
     kAny, "road|plain"},
    {"width", Type::number, Dimension::length, "'7 m'", "Kerb to kerb.", kPositive},
    {"centre_y", Type::number, Dimension::length, "'0 m'",
     "Where its middle runs. Traffic keeps right: lanes along +x lie at smaller y."},
    {"lanes", Type::integer, Dimension::none, "2", "Lanes in all.", between(1, 12)},
    {"grid", Type::boolean, Dimension::none, "false", "A grid of metres on the road as well."},
    {"zebra", Type::number, Dimension::length, "", "x of a pedestrian crossing; left out: none."},
};

const Key kSkyKeys[] = {
    {"sun_azimuth", Type::number, Dimension::angle, "'130 deg'", "Direction to the sun, from +x towards +y."},
    {"sun_elevation", Type::number, Dimension::angle, "'46 deg'", "Height of the sun.", between(0.02, 1.5707964)},
    {"haze", Type::number, Dimension::none, "0.4", "0 clear, 1 fog.", kShare},
};

bool subject_exists(const Builder& builder, const std::string& name) {
  const engine::Model& model = builder.scene.model;
  if (builder.is_declared(name) && name.find('/') == std::string::npos) return true;
  return builder.body_index(name) >= 0 ||
         std::any_of(model.persons.begin(), model.persons.end(), [&](const auto& p) { return p.name == name; }) ||
         std::any_of(model.vehicles.begin(), model.vehicles.end(), [&](const auto& v) { return v.name == name; });
}

void read_camera(Builder& builder, Reader& r) {
  render::Camera camera;
  camera.name = r.text("name");
  for (const render::Camera& other : builder.scene.stage.cameras)
    if (other.name == camera.name) r.fail("name", "is taken; every camera needs a name of its own");
  camera.kind = static_cast<render::CameraKind>(r.choice("kind"));
  camera.position = r.vector("position");
  camera.target = r.vector("target");
  camera.follow = r.text("follow");
  if (!camera.follow.empty() && !subject_exists(builder, camera.follow)) {
    std::vector<std::string> names = builder.body_names();
    for (const auto& person : builder.scene.model.persons) names.push_back(person.name);
    const std::string guess = nearest(camera.follow, names);
    r.fail("follow", guess.empty() ? "is no body, vehicle or person of the scene"
                                   : fmt::format("is no body, vehicle or person of the scene; did you mean \"{}\"?", guess));
  }
  camera.vertical_fov = r.number("fov");
  camera.orbit_radius = r.number("radius");
  camera.orbit_height = r.number("height");
  camera.orbit_start = r.number("start");
  camera.orbit_rate = r.number("rate");
  camera.top_height = r.number("span");
  camera.smoothing = r.number("smoothing");
  if (camera.kind == render::CameraKind::fixed && (camera.position - camera.target).norm() < 1e-6) {
    r.fail("target", "must differ from position; a camera needs a direction");
  }
  builder.scene.stage.cameras.push_back(std::move(camera));
}

void check_camera_name(Builder& builder, Reader& r, const std::string& name) {
  std::vector<std::string> names;
  for (const render::Camera& camera : builder.scene.stage.cameras) names.push_back(camera.name);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  const std::string guess = nearest(name, names);
  r.fail("camera",
         guess.empty() ? "is no camera of the scene" : fmt::format("is no camera of the scene; did you mean \"{}\"?", guess));
}

void read_shot(Builder& builder, Reader& r) {
  render::Shot shot;
  shot.camera = r.text("camera");
  check_camera_name(builder, r, shot.camera);
  shot.from = r.number("from");
  shot.to = r.number_if("to").value_or(std::max(shot.from, builder.scene.model.settings.duration));
  shot.speed = r.number("speed");
  shot.hold = r.number("hold");
  if (shot.to < shot.from) r.fail("to", "must not be earlier than from");
  if (shot.speed == 0 && shot.hold == 0)
    r.fail("hold", "must be greater than 0 s where speed is 0; a frozen picture needs a duration");
  builder.scene.stage.shots.push_back(shot);
}

void read_overlays(Builder& builder, Reader r) {
  render::Overlays& o = builder.scene.stage.overlays;
  o.contacts = r.boolean("contacts");
  o.forces = r.boolean("forces");
  o.caption = r.boolean("caption");
  o.traces = r.boolean("traces");
  o.disclaimer = r.boolean("disclaimer");
  o.scale_bar = r.boolean("scale_bar");
  o.newtons_per_metre = r.number("force_scale");
  o.trace_bodies = r.texts("trace_bodies");
  for (const std::string& name : o.trace_bodies) {
    const bool told = !builder.errors.empty() && builder.is_declared(name);
    if (builder.body_index(name) >= 0 || told) continue;
    const std::string guess = nearest(name, builder.body_names());
    r.fail("trace_bodies", fmt::format("must name bodies of the scene; \"{}\" is none{}", name,
                                       guess.empty() ? "" : fmt::format(", did you mean \"{}\"?", guess)));
  }
  if (o.trace_bodies.empty()) {
    for (const engine::Person& person : builder.scene.model.persons) {
      for (int body : {person.head, person.hips})
        if (body >= 0) o.trace_bodies.push_back(builder.scene.model.bodies[static_cast<std::size_t>(body)].name);
    }
  }
}

void read_output(Builder& builder, Reader r) {
  Output& out = builder.scene.output;
  out.width = r.integer("width");
  out.height = r.integer("height");
  out.fps = r.number("fps");
  out.quality = split_choices(r.section().find("quality")->choices)[static_cast<std::size_t>(r.choice("quality"))];
  for (const char* key : {"width", "height"}) {
    if (r.integer(key) % 2 != 0) r.fail(key, "must be even; the video's colour is stored for pairs of pixels");
  }
  for (Reader& still : r.tables("still")) {
    const std::string camera = still.text("camera");
    if (!camera.empty()) check_camera_name(builder, still, camera);
    out.stills.emplace_back(still.number("time"), camera);
  }
}

void read_road_and_sky(Builder& builder, Reader road, Reader sky) {
  render::RoadLook& look = builder.scene.stage.road;
  look.road = road.choice("kind") == 0;
  look.height = builder.scene.model.ground.height;
  look.width = road.number("width");
  look.centre_y = road.number("centre_y");
  look.lanes = road.integer("lanes");
  look.metre_grid = road.boolean("grid") || !look.road;
  look.zebra = road.has("zebra");
  if (look.zebra) look.zebra_x = road.number("zebra");
  builder.scene.stage.sky = {sky.number("sun_azimuth"), sky.number("sun_elevation"), sky.number("haze")};
}

}  // namespace

const Section kCameraSection{"camera", "[[camera]]",
                             "A camera. A scene without one gets \"overview\", which looks at where things are at the start.",
                             kCameraKeys};
const Section kShotSection{"shot", "[[shot]]",
                           "A stretch of film. Without shots: the whole run from the first camera at natural speed.", kShotKeys};
const Section kOverlaysSection{"overlays", "[overlays]", "What is drawn over the picture.", kOverlayKeys};
const Section kOutputSection{"output", "[output]", "Size and rate of pictures; the command line overrides.", kOutputKeys};
const Section kRoadSection{"road", "[road]", "What the ground plane looks like; its friction stands in [ground].", kRoadKeys};
const Section kSkySection{"sky", "[sky]", "Sun and air.", kSkyKeys};

namespace {

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

void read_film(Builder& builder, Reader& scene) {
  const auto section = [&](std::string_view key, const Section& s) {
    const auto reader = scene.table(key);
    return reader ? *reader : Reader(empty_table(), s, std::string(key), builder.errors);
  };
  for (Reader& camera : scene.tables("camera")) read_camera(builder, camera);
  if (builder.scene.stage.cameras.empty()) builder.scene.stage.cameras.push_back(overview(builder.scene.model));
  for (Reader& shot : scene.tables("shot")) read_shot(builder, shot);
  read_overlays(builder, section("overlays", kOverlaysSection));
  read_output(builder, section("output", kOutputSection));
  read_road_and_sky(builder, section("road", kRoadSection), section("sky", kSkySection));
}

}  // namespace scenes
