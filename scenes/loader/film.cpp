// What the scene looks like and how it is filmed: [[camera]], [[shot]], [overlays], [output], [road], [sky].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/math/functions.h"
#include "scenes/loader/builder.h"
#include "scenes/loader/sha256.h"

namespace scenes {
namespace {

constexpr double kFilmHeight = 0.024;  // [m] of the 35 mm still format that focal lengths are spoken of in

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
    bound<&render::Camera::kind>(
        {"kind", Type::choice, Dimension::none, "'fixed'",
         "Stands still; keeps its offset; circles; looks straight down; sees with a driver or a person; or moves along knots.",
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
    {"lens", Type::number, Dimension::length, "",
     "Focal length in place of fov, for a picture 24 mm high (35 mm still format): \"50 mm\".", between(0.006, 1)},
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

const Key kDimensionKeys[] = {
    bound<&render::Dimension::label>({"label", Type::text, Dimension::none, "''", "Stands before the number."}),
    {"body", Type::text, Dimension::none, "''", "How far this body, vehicle or person has come, level, since a time."},
    bound<&render::Dimension::since>({"since", Type::number, Dimension::time, "'0 s'", "That time.", kNotNegative}),
    bound<&render::Dimension::from>({"from", Type::vector3, Dimension::length, "", "Without body: one end."}),
    bound<&render::Dimension::to>({"to", Type::vector3, Dimension::length, "", "Without body: the other end."}),
};
const Section kDimensionSection{"overlays.dimension", "[[overlays.dimension]]", "A line with its length in numbers.",
                                kDimensionKeys};

const Key kOverlayKeys[] = {
    bound<&render::Overlays::contacts>({"contacts", Type::boolean, Dimension::none, "true", "Contact points and normals."}),
    bound<&render::Overlays::forces>({"forces", Type::boolean, Dimension::none, "true", "Arrows, long by force."}),
    bound<&render::Overlays::caption>({"caption", Type::boolean, Dimension::none, "true", "Time, speeds, camera."}),
    bound<&render::Overlays::traces>({"traces", Type::boolean, Dimension::none, "false", "Paths of the bodies in trace_bodies."}),
    bound<&render::Overlays::vehicle_paths>(
        {"vehicle_paths", Type::boolean, Dimension::none, "false", "The way of each vehicle, on the ground."}),
    bound<&render::Overlays::wheel_traces>({"wheel_traces", Type::boolean, Dimension::none, "false",
                                            "Where each wheel rolled. (Skid marks, where tyres slid, are always drawn.)"}),
    bound<&render::Overlays::trace_bodies>({"trace_bodies", Type::texts, Dimension::none, "[]",
                                            "Bodies whose paths are drawn; empty: head and hips of every person."}),
    bound<&render::Overlays::disclaimer>(
        {"disclaimer", Type::boolean, Dimension::none, "true", "\"Simulation, not footage\" and the provenance at the foot."}),
    bound<&render::Overlays::scale_bar>({"scale_bar", Type::boolean, Dimension::none, "true", "A bar of metres in top views."}),
    bound<&render::Overlays::legend>(
        {"legend", Type::boolean, Dimension::none, "false", "What colours and lengths of arrows and marks mean."}),
    bound<&render::Overlays::contact_history>(
        {"contact_history", Type::boolean, Dimension::none, "false", "Marks on vehicles and persons where they touched so far."}),
    bound<&render::Overlays::contact_colour>({"contact_colour", Type::choice, Dimension::none, "'time'",
                                              "Their colours: when it touched, or how hard.", kAny, "time|impulse"}),
    bound<&render::Overlays::ghost_interval>({"ghost_interval", Type::number, Dimension::time, "",
                                              "Pale figures of persons and free bodies at equal times.", between(0.005, 60)}),
    bound<&render::Overlays::ghost_distance>(
        {"ghost_distance", Type::number, Dimension::length, "", "Pale figures at equal distances travelled.", between(0.02, 1000)}),
    bound<&render::Overlays::velocities>(
        {"velocities", Type::boolean, Dimension::none, "false", "Velocity arrows of vehicles and persons, with numbers."}),
    bound<&render::Overlays::velocity_scale>(
        {"velocity_scale", Type::number, Dimension::speed, "'8 m/s'", "Speed that one metre of arrow stands for.", kPositive}),
    bound<&render::Overlays::speed_chart>(
        {"speed_chart", Type::boolean, Dimension::none, "false", "Speeds over time, running with the film."}),
    bound<&render::Overlays::energy_chart>(
        {"energy_chart", Type::boolean, Dimension::none, "false", "Energies over time, running with the film."}),
    {"dimension", Type::tables, Dimension::none, "", "Lengths with their numbers.", kAny, {}, &kDimensionSection},
    bound<&render::Overlays::newtons_per_metre>(
        {"force_scale", Type::number, Dimension::stiffness, "'10 kN/m'", "Force that one metre of arrow stands for.", kPositive}),
};

const Key kStillKeys[] = {
    bound<&Output::Still::time>({"time", Type::number, Dimension::time, kRequired, "Simulated time.", kNotNegative}),
    bound<&Output::Still::camera>(
        {"camera", Type::text, Dimension::none, "''", "Camera; left out: seen as the film shows this time, two cameras included."}),
    {"card", Type::integer, Dimension::none, "", "The film's first, second ... card in place of a camera.", between(1, 100)},
};
const Section kStillSection{"output.still", "[[output.still]]", "Stills a snapshot test draws.", kStillKeys};

const Key kOutputKeys[] = {
    bound<&Output::width>({"width", Type::integer, Dimension::none, "1280", "Picture width in pixels, even.", between(16, 8192)}),
    bound<&Output::height>({"height", Type::integer, Dimension::none, "720", "Picture height in pixels, even.", between(16, 8192)}),
    bound<&Output::fps>({"fps", Type::number, Dimension::none, "30", "Frames a second.", between(1, 1000)}),
    bound<&Output::quality>(
        {"quality", Type::choice, Dimension::none, "'standard'", "Effort a frame.", kAny, "draft|standard|fine"}),
    {"still", Type::tables, Dimension::none, "", "Stills for snapshot tests.", kAny, {}, &kStillSection},
};

const Key kRoadKeys[] = {
    {"kind", Type::choice, Dimension::none, "'plain'", "Asphalt with lane markings along x, or plain ground with a metre grid.",
     kAny, "road|plain"},
    bound<&render::RoadLook::width>({"width", Type::number, Dimension::length, "'7 m'", "Kerb to kerb.", kPositive}),
    bound<&render::RoadLook::centre_y>({"centre_y", Type::number, Dimension::length, "'0 m'",
                                        "Where its middle runs. Traffic keeps right: lanes along +x lie at smaller y."}),
    bound<&render::RoadLook::lanes>({"lanes", Type::integer, Dimension::none, "2", "Lanes in all.", between(1, 12)}),
    {"grid", Type::boolean, Dimension::none, "false", "A grid of metres on the road as well."},
    bound<&render::RoadLook::zebra_x>(
        {"zebra", Type::number, Dimension::length, "", "x of a pedestrian crossing; left out: none."}),
    {"picture", Type::path, Dimension::none, "", "A PNG that lies on the ground: an aerial photograph, a drawing to scale."},
    bound<&render::RoadLook::picture_width>(
        {"picture_width", Type::number, Dimension::length, "'50 m'", "How wide the picture is on the ground.", kPositive}),
    {"picture_corner", Type::vector2, Dimension::length, "'0 0 m'", "Where its lower left corner lies."},
    bound<&render::RoadLook::picture_turn>(
        {"picture_heading", Type::number, Dimension::angle, "'0 deg'", "Where its lower edge points, from +x towards +y."}),
};

const Key kSkyKeys[] = {
    bound<&render::Stage::north>({"north", Type::number, Dimension::angle, "",
                                  "Where north is, from +x towards +y; top views show it. Left out: they show x."}),
    bound<&render::SkyLook::sun_azimuth>(
        {"sun_azimuth", Type::number, Dimension::angle, "'130 deg'", "Direction to the sun, from +x towards +y."}),
    bound<&render::SkyLook::sun_elevation>(
        {"sun_elevation", Type::number, Dimension::angle, "'46 deg'", "Height of the sun.", between(0.02, 1.5707964)}),
    bound<&render::SkyLook::haze>({"haze", Type::number, Dimension::none, "0.4", "0 clear, 1 fog.", kShare}),
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
  r.fill(camera);
  for (const render::Camera& other : builder.scene.stage.cameras)
    if (other.name == camera.name) r.fail("name", "this name is already used; every camera needs a name of its own");
  if (!camera.follow.empty() && !subject_exists(builder, camera.follow)) {
    std::vector<std::string> names = builder.body_names();
    for (const auto& person : builder.scene.model.persons) names.push_back(person.name);
    const std::string guess = nearest(camera.follow, names);
    r.fail("follow", guess.empty() ? "is no body, vehicle or person of the scene"
                                   : fmt::format("is no body, vehicle or person of the scene; did you mean \"{}\"?", guess));
  }
  if (const auto lens = r.number_if("lens")) camera.vertical_fov = 2 * engine::math::atan(kFilmHeight / 2 / *lens);
  if (r.has("lens") && r.has("fov")) r.fail("lens", "says the same as fov; give one of them");
  const bool straight = camera.kind == render::CameraKind::fixed || camera.kind == render::CameraKind::eye;
  if (straight && (camera.position - camera.target).norm() < 1e-6) {
    r.fail("target", "must differ from position; a camera needs a direction");
  }
  read_knots(r, camera);
  builder.scene.stage.cameras.push_back(std::move(camera));
}

void check_camera_name(Builder& builder, Reader& r, const std::string& name, std::string_view key = "camera") {
  std::vector<std::string> names;
  for (const render::Camera& camera : builder.scene.stage.cameras) names.push_back(camera.name);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  const std::string guess = nearest(name, names);
  r.fail(key, guess.empty() ? "is no camera of the scene" : fmt::format("is no camera of the scene; did you mean \"{}\"?", guess));
}

void read_shot(Builder& builder, Reader& r) {
  render::Shot shot;
  r.fill(shot);
  check_camera_name(builder, r, shot.camera);
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

/// Body of the Model that a body, vehicle or person goes by; -1: none.
int body_of(const Builder& builder, const std::string& name) {
  const engine::Model& model = builder.scene.model;
  for (const engine::Person& person : model.persons)
    if (person.name == name) return person.hips;
  for (const engine::Vehicle& vehicle : model.vehicles)
    if (vehicle.name == name) return vehicle.body;
  return builder.body_index(name);
}

void read_dimension(Builder& builder, Reader& r) {
  render::Dimension d;
  r.fill(d);
  const std::string name = r.text("body");
  if (name.empty()) {
    if (!r.has("from") || !r.has("to")) r.fail_here("needs a body, or from and to");
  } else {
    d.body = body_of(builder, name);
    const bool told = !builder.errors.empty() && builder.is_declared(name);
    if (d.body < 0 && !told) r.fail("body", "is no body, vehicle or person of the scene");
    if (r.has("from") || r.has("to")) r.fail("body", "needs no from and to; it is measured from where it was at since");
  }
  builder.scene.stage.overlays.dimensions.push_back(d);
}

void read_overlays(Builder& builder, Reader r) {
  render::Overlays& o = builder.scene.stage.overlays;
  r.fill(o);
  for (Reader& dimension : r.tables("dimension")) read_dimension(builder, dimension);
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
  r.fill(out);
  for (const char* key : {"width", "height"}) {
    if (r.integer(key) % 2 != 0) r.fail(key, "must be even; the video's colour is stored for pairs of pixels");
  }
  for (Reader& still : r.tables("still")) {
    Output::Still& drawn = out.stills.emplace_back();
    still.fill(drawn);
    if (!drawn.camera.empty()) check_camera_name(builder, still, drawn.camera);
    if (still.has("card")) drawn.card = still.integer("card") - 1;
    const int cards = static_cast<int>(builder.scene.stage.cards.size());
    if (drawn.card >= cards) still.fail("card", fmt::format("must be one of the scene's {} cards", cards));
  }
}

/// Of what is drawn, not of a second look at the file.
std::string pixels_hash(const render::GroundPicture& picture) {
  const render::GroundPicture::Level& level = picture.levels.front();
  return sha256(fmt::format("{}x{}", level.width, level.height) +
                sha256({reinterpret_cast<const char*>(level.texels.data()), level.texels.size() * sizeof level.texels[0]}));
}

/// A picture beside the scene, or of the program.
void read_ground_picture(Builder& builder, Reader& r, render::RoadLook& look) {
  const std::filesystem::path file = asset_file(builder, r, "picture", "a PNG file");
  if (file.empty()) return;
  std::string problem;
  look.picture = render::read_ground_picture(file, problem);
  if (!look.picture) {
    r.fail("picture", problem);
    return;
  }
  builder.assets += pixels_hash(*look.picture);
  const engine::Vec3 corner = r.vector("picture_corner");
  look.picture_x = corner.x();
  look.picture_y = corner.y();
}

void read_road_and_sky(Builder& builder, Reader road, Reader sky) {
  render::RoadLook& look = builder.scene.stage.road;
  road.fill(look);
  look.road = road.choice("kind") == 0;
  const engine::Ground& ground = builder.scene.model.ground;
  // the drawn plane hides what dips below it: where only a terrain is the ground, it lies under all of that
  look.height = ground.plane || !ground.terrain ? ground.height : ground.terrain->bounds().lower.z() - 0.02;
  look.metre_grid = road.boolean("grid") || !look.road;
  look.zebra = road.has("zebra");
  if (road.has("picture")) read_ground_picture(builder, road, look);
  sky.fill(builder.scene.stage.sky);
  sky.fill(builder.scene.stage);
}

}  // namespace

const Section kCameraSection{"camera", "[[camera]]",
                             "A camera. A scene without one gets \"overview\", which looks at where things are at the start.",
                             kCameraKeys};
const Section kShotSection{"shot", "[[shot]]",
                           "A stretch of film. Without shots: the whole run from the first camera at natural speed.", kShotKeys};
const Section kCardSection{"card", "[[card]]", "A page of text in the film: title, assumptions, results.", kCardKeys};
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
  for (Reader& card : scene.tables("card")) card.fill(builder.scene.stage.cards.emplace_back());
  read_overlays(builder, section("overlays", kOverlaysSection));
  read_output(builder, section("output", kOutputSection));
  read_road_and_sky(builder, section("road", kRoadSection), section("sky", kSkySection));
}

}  // namespace scenes
