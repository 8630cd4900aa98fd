// [[vehicle]]: a rigid body on wheels, from the library or the user's own mesh and figures.
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/functions.h"
#include "scenes/loader/builder.h"
#include "scenes/loader/decimate.h"
#include "scenes/loader/figure.h"
#include "scenes/loader/mesh.h"
#include "scenes/loader/mesh_frame.h"
#include "scenes/loader/panels.h"

namespace scenes {
namespace {

enum class Coupling { ball, turntable };

/// What the vehicle's body, place and actors follow from. Points in the mesh frame.
struct VehicleGiven {
  std::string title;
  double mesh_tolerance = 0;                                 // [m]
  engine::Vec3 cg = engine::Vec3::Zero();                    // [m]
  std::optional<engine::Vec3> front;                         // [m] world x, y
  double lift = 0;                                           // [m]
  std::optional<engine::Vec3> hitch, coupling, saddle, eye;  // [m]
  Coupling coupling_kind = Coupling::ball;
  std::optional<render::Colour> colour;
};

const Key kVehicleKeys[] = {
    bound<&engine::Vehicle::name>(
        {"name", Type::text, Dimension::none, "''", "Name in every output. (Required in a scene; a library file has none.)"}),
    {"model", Type::text, Dimension::none, "''",
     "A vehicle of the library or the scene's folder, whose keys are used where the scene gives none. Empty: all is given here."},
    bound<&VehicleGiven::title>(
        {"title", Type::text, Dimension::none, "''", "What the library's vehicle is and where its figures come from."}),
    {"mesh", Type::path, Dimension::none, "",
     "The bodywork. Mesh frame: x forward, y left, z up, origin on the ground midway between the axles."},
    CRASHREEL_MESH_KEYS,
    {"collision_mesh", Type::path, Dimension::none, "", "A coarser mesh for contact in the same frame; left out: the bodywork."},
    bound<&VehicleGiven::mesh_tolerance>(
        {"mesh_tolerance", Type::number, Dimension::length, "0",
         "The mesh for contact is thinned out; no point of either surface is farther than this from the other. 0: as it is.",
         kNotNegative}),
    {"wheel_mesh", Type::path, Dimension::none, "", "One wheel about its centre, axle along y, outside towards +y."},
    bound<&engine::Body::mass>({"mass", Type::number, Dimension::mass, "", "Mass with occupants.", kPositive}),
    bound<&VehicleGiven::cg>({"cg", Type::vector3, Dimension::length, "", "Centre of mass in the mesh frame."}),
    bound<&engine::Body::inertia_B>(
        {"inertia", Type::inertia, Dimension::inertia, "",
         "Roll, pitch, yaw moments about the centre of mass, or a tensor. Left out beside a mass of the scene's: "
         "the model's, in proportion to the mass."}),
    bound<&Placing::position>({"position", Type::vector2, Dimension::length, "'0 0 m'", "World x, y of the mesh frame's origin."}),
    bound<&VehicleGiven::front>(
        {"front", Type::vector2, Dimension::length, "", "World x, y of the middle of the front bumper, in place of position."}),
    bound<&Placing::heading>({"heading", Type::number, Dimension::angle, "'0 deg'", "Where it points, from +x towards +y."}),
    bound<&Placing::speed>({"speed", Type::number, Dimension::speed, "'0 m/s'", "Along the heading."}),
    bound<&Placing::velocity>(
        {"velocity", Type::vector3, Dimension::speed, "", "Of the centre of mass in world axes, in place of speed."}),
    bound<&engine::Body::V_WB, &engine::Twist::w>(
        {"angular_velocity", Type::vector3, Dimension::angular_speed, "'0 0 0 rad/s'", "In world axes."}),
    bound<&VehicleGiven::lift>(
        {"lift", Type::number, Dimension::length, "'0 m'", "Height above its place on the wheels, for a vehicle in the air."}),
    bound<&Attitude::roll_pitch_yaw>(
        {"attitude", Type::vector3, Dimension::angle, "'0 0 0 deg'", "Roll, pitch, yaw on top of the heading."}),
    bound<&Attitude::quaternion>({"quaternion", Type::numbers, Dimension::none, "", "The same as [w, x, y, z]."}),
    bound<&engine::Vehicle::drag>(
        {"drag", Type::vector3, Dimension::none, "[0.3, 0.8, 1]",
         "Drag coefficients of the air along its length, width and height, by the sides of the box round it.", kNotNegative}),
    bound<&VehicleGiven::hitch>({"hitch", Type::vector3, Dimension::length, "", "Where it tows a trailer, in the mesh frame."}),
    bound<&VehicleGiven::coupling>({"coupling", Type::vector3, Dimension::length, "", "Where it is towed, in the mesh frame."}),
    bound<&VehicleGiven::coupling_kind>(
        {"coupling_kind", Type::choice, Dimension::none, "'ball'",
         "A ball leaves all turns, a turntable only the turn about the vertical (the trailer on its steered front axle).", kAny,
         "ball|turntable"}),
    {"towed_by", Type::text, Dimension::none, "''",
     "A vehicle above in the file: coupling is put on its hitch; place and speed are left out, heading is its own unless given."},
    bound<&VehicleGiven::saddle>({"saddle", Type::vector3, Dimension::length, "", "Centre of a rider's hips, in the mesh frame."}),
    bound<&VehicleGiven::eye>({"eye", Type::vector3, Dimension::length, "",
                               "Where `--camera driver` looks from, in the mesh frame. Left out: estimated."}),
    {"brake", Type::table, Dimension::none, "", "Braking.", kAny, {}, &kBrakeSection},
    {"driver", Type::tables, Dimension::none, "", "What the driver does, act by act.", kAny, {}, &kDriverSection},
    {"path", Type::table, Dimension::none, "", "A line to steer along.", kAny, {}, &kPathSection},
    bound<&engine::Vehicle::steer>(
        {"steer", Type::schedule, Dimension::angle, "'0 deg'", "Angle of the steered wheels, left positive."}),
    bound<&engine::Vehicle::drive_force>(
        {"drive_force", Type::schedule, Dimension::force, "'0 N'", "Shared by the driven wheels."}),
    CRASHREEL_SURFACE_KEYS,
    bound<&engine::Body::collision_model>(
        {"collision", Type::choice, Dimension::none, "'default_auto'",
         "Collision model the vehicle asks for. Kudlich-Slibar acts between two meshes that both ask for it, Default-Auto in every "
         "other case.",
         kAny, "default_auto|kudlich_slibar"}),
    bound<&VehicleGiven::colour>({"colour", Type::colour, Dimension::none, "", "Of the paint, in place of the mesh's own."}),
    {"wheel",
     Type::tables,
     Dimension::none,
     "",
     "Wheels. Of a model's, those named here without `at` are changed by what is given, and the others stay.",
     kAny,
     {},
     &kWheelSection},
};

/// The model's wheels, with what the scene says of single ones, by name. A list that gives their places, and what is
/// no list of wheels, stands for itself.
Value wheels_over(const Value& model, const Value& scene) {
  std::vector<std::pair<std::string, const Value*>> changes;
  bool whole = true;
  for (const Entry& by_name : scene.entries) changes.emplace_back(by_name.key, &by_name.value), whole = false;  // of --set
  for (const Value& wheel : scene.items) {
    const Value* name = wheel.find("name");
    changes.emplace_back(name ? name->text : "", &wheel);
    whole = whole && wheel.find("at");
  }
  if (whole) return scene;
  Value out = model;
  for (const auto& [name, change] : changes) {
    Value* wheel = name.empty() || change->kind != Value::Kind::table ? nullptr : element_of(out, name);
    if (!wheel) return scene;
    *wheel = overlaid(*wheel, *change);
  }
  return out;
}

/// The scene's table over the library's: a coefficient for both kinds takes the place of those of each.
Value laid_over(Value model, const Value& scene) {
  for (const std::string key : {"friction", "restitution"})
    if (scene.find(key))
      std::erase_if(model.entries, [&](const Entry& e) { return e.key == key + "_body" || e.key == key + "_ground"; });
  Value out = overlaid(model, scene);
  if (const Value* of_model = model.find("wheel"), *of_scene = scene.find("wheel"); of_model && of_scene)
    *out.find("wheel") = wheels_over(*of_model, *of_scene);
  return out;
}

struct Laid {
  Value tree;
  double mass = 0;  // [kg] that the inertia in it is of, where it is the model's and the mass is the scene's; else 0
};

/// The mass of a model whose inertia the scene leaves as it is, and whose mass it does not.
double mass_of_inertia(const Value& model, const Reader& scene) {
  if (!scene.has("mass") || scene.has("inertia") || !model.find("mass") || !model.find("inertia")) return 0;
  Errors told_elsewhere;
  return Reader(model, kVehicleSection, scene.path(), told_elsewhere).number("mass");
}

/// The scene's table laid over the library's.
std::optional<Laid> with_model(Builder& builder, Reader& r) {
  const std::string name = r.text("model");
  if (name.empty()) return Laid{r.value()};
  if (const auto model = library_entry(builder, "vehicles", name))
    return Laid{laid_over(*model, r.value()), mass_of_inertia(*model, r)};
  r.fail("model", not_in_library(builder, "vehicles", "model", name));
  return std::nullopt;
}

void need(Reader& r, std::string_view key, std::string_view example) {
  if (!r.has(key)) r.fail(key, fmt::format("is missing; write like {} = {}, or name a model of the library", key, example));
}

/// A car is some metres long; a mesh in centimetres or feet is the commonest slip of all.
void check_scale(Reader& r, const engine::Aabb& box) {
  const engine::Vec3 size = box.upper - box.lower;
  if (size.x() > 7 || size.x() < 2.5)
    r.warn("mesh", fmt::format("is {:.4g} m long; is its scale right? Meshes are read in metres", size.x()));
  if (size.z() > size.x())
    r.warn("mesh", fmt::format("is {:.4g} m high and {:.4g} m long; is z its up axis and x its forward axis?", size.z(), size.x()));
}

struct Meshes {
  std::shared_ptr<const ImportedMesh> bodywork, collision;
  std::vector<std::shared_ptr<const ImportedMesh>> wheels;  // null: not drawn
};

enum class Origin { library, user };

Meshes read_meshes(Builder& builder, Reader& r, Origin origin) {
  Meshes out;
  out.bodywork = import_mesh(builder, r, "mesh");
  out.collision = r.has("collision_mesh") ? import_mesh(builder, r, "collision_mesh") : out.bodywork;
  if (out.bodywork) {
    const MeshFrame frame = origin == Origin::user ? vehicle_frame(r, *out.bodywork) : given_frame(r);
    out.bodywork = in_frame(builder, out.bodywork, frame);
    out.collision = in_frame(builder, out.collision, frame);
    for (auto* mesh : {&out.bodywork, &out.collision}) {
      if (!*mesh || !(*mesh)->solid->empty()) continue;
      r.fail("mesh_scale", "leaves no triangle with an area; there is nothing to touch");
      return {};
    }
    if (origin == Origin::user && !r.has("mesh_scale")) check_scale(r, out.bodywork->solid->bounds());
  }
  const auto wheel = r.has("wheel_mesh") ? import_mesh(builder, r, "wheel_mesh") : nullptr;
  for (Reader& w : r.tables("wheel")) out.wheels.push_back(w.has("mesh") ? import_mesh(builder, w, "mesh") : wheel);
  return out;
}

void add_actors(Builder& builder, const VehicleGiven& given, const engine::Vehicle& vehicle, const Meshes& meshes,
                const engine::MeshShape& shape) {
  render::Stage& stage = builder.scene.stage;
  std::vector<render::Material> repaint;
  if (given.colour) {
    for (const render::Material& material : meshes.bodywork->look->materials) {
      if (material.kind != render::MaterialKind::paint) continue;
      repaint.push_back(material);
      repaint.back().colour = *given.colour;
    }
  }
  stage.meshes.push_back({vehicle.name, vehicle.body, shape.X_BM, meshes.bodywork->look, std::move(repaint), shape.mesh});
  for (std::size_t i = 0; i < vehicle.wheels.size(); ++i) {
    if (!meshes.wheels[i]) continue;
    stage.wheels.push_back({static_cast<int>(builder.scene.model.vehicles.size()), static_cast<int>(i), vehicle.body,
                            vehicle.wheels[i].hub_B.y() > 0, meshes.wheels[i]->look});
  }
  stage.speeds.push_back({vehicle.body, vehicle.name});
  stage.vehicles.push_back(vehicle.body);
  if (given.eye) stage.eyes[vehicle.body] = *given.eye - given.cg;
}

/// The mesh for contact, thinned out, with its panels.
engine::MeshShape collision_shape(Builder& builder, const Meshes& meshes, const engine::Pose& X_BM, double tolerance) {
  auto& coarse = builder.scene.meshes->coarse[{meshes.collision->solid->mesh(), tolerance}];
  if (!coarse) coarse = decimate(meshes.collision->solid->mesh(), tolerance);
  auto& panels = builder.scene.meshes->panels[{coarse, meshes.bodywork->look}];
  if (!panels) panels = panels_of(*coarse, *meshes.bodywork->look);
  return {coarse, X_BM, tolerance, panels};
}

/// Where the wheels of a vehicle whose mesh frame stands at X_WM are, with the height of the ground under each; those over a hole,
/// or beyond an edge, left out.
struct OnGround {
  engine::Vec3 from;  // [m] from the mesh frame's place, world axes
  double height = 0;  // [m]
};
std::vector<OnGround> on_ground(const engine::Ground& ground, const engine::Vehicle& vehicle, const engine::Vec3& cg,
                                const engine::Pose& X_WM) {
  std::vector<OnGround> out;
  for (const engine::Wheel& wheel : vehicle.wheels) {
    const engine::Vec3 from = X_WM.q * engine::Vec3(wheel.hub_B.x() + cg.x(), wheel.hub_B.y() + cg.y(), 0);
    if (const auto height = ground_beneath(ground, X_WM.p.x() + from.x(), X_WM.p.y() + from.y())) out.push_back({from, *height});
  }
  return out;
}

/// The turn that lays a level vehicle along the ground under its wheels: the plane of least squares through it.
engine::Quat along_ground(const std::vector<OnGround>& wheels) {
  if (wheels.size() < 2) return engine::Quat::Identity();
  engine::Mat3 squares = engine::Vec3(1e-9, 1e-9, 1e-9).asDiagonal();  // of a two-wheeler, which tells no slope aside
  engine::Vec3 sum = engine::Vec3::Zero();
  for (const OnGround& wheel : wheels) {
    const engine::Vec3 row(1, wheel.from.x(), wheel.from.y());
    squares += row * row.transpose();
    sum += wheel.height * row;
  }
  const engine::Vec3 plane = squares.ldlt().solve(sum);
  return engine::Quat::FromTwoVectors(engine::Vec3::UnitZ(), engine::Vec3(-plane.y(), -plane.z(), 1).normalized());
}

/// Does the scene leave it to the ground how a vehicle stands?
bool stands_freely(const Builder& builder, const Reader& r) {
  return builder.scene.model.ground.terrain && !r.has("attitude") && !r.has("quaternion");
}

/// Sets a vehicle down on its wheels: along the ground if the scene gives no attitude, and none of them below it. Its speed turns
/// with it. One that is towed goes where its hitch is.
void set_down(Builder& builder, Reader& r, const engine::Vehicle& vehicle, const engine::Vec3& cg, engine::Pose& X_WM,
              engine::Vec3& v) {
  constexpr double kFlat = 1e-6;  // [m] level ground at its own height is left as it is
  const engine::Ground& ground = builder.scene.model.ground;
  if (!ground.terrain || !r.text("towed_by").empty()) return;
  if (stands_freely(builder, r)) {
    const engine::Quat tilt = along_ground(on_ground(ground, vehicle, cg, X_WM));
    if (tilt.vec().norm() > kFlat) {
      X_WM.q = tilt * X_WM.q;
      if (!r.has("velocity")) v = tilt * v;
    }
  }
  double up = -std::numeric_limits<double>::infinity();
  for (const OnGround& wheel : on_ground(ground, vehicle, cg, X_WM))
    up = std::max(up, wheel.height - ground.height - wheel.from.z());
  if (std::isfinite(up) && std::abs(up) > kFlat) X_WM.p.z() += up;
}

/// Where the mesh frame stands in the world, on level ground.
engine::Pose mesh_pose(Builder& builder, Reader& r, const VehicleGiven& given, const Placing& placing, const Meshes& meshes) {
  engine::Vec3 at = placing.position;
  if (given.front) {
    if (r.has("position")) r.fail("front", "must not be given together with position");
    at = *given.front - meshes.bodywork->solid->bounds().upper.x() * placing.ahead();
  }
  at.z() = builder.scene.model.ground.height + given.lift;
  return {at, engine::math::rotation(placing.heading, engine::Vec3::UnitZ()) * read_attitude(r)};
}

/// The vehicle that tows this one, -1: none; all that is wrong with it is told.
int find_tower(Builder& builder, Reader& r) {
  const std::string name = r.text("towed_by");
  if (name.empty()) return -1;
  const int tower = builder.body_index(name);
  if (tower < 0 || !builder.hitches.contains(name)) {
    r.fail("towed_by", tower < 0 ? "is no vehicle above in the file" : "is no vehicle with a hitch");
    return -1;
  }
  if (!r.has("coupling")) r.fail("towed_by", "needs a coupling, the place where this vehicle is towed");
  for (const char* key : {"position", "front", "speed", "velocity"})
    if (r.has(key)) r.fail(key, "must not be given for a towed vehicle; it goes with the vehicle that tows it");
  return tower;
}

/// Puts a towed vehicle on its hitch and joins the two.
void couple(Builder& builder, Reader& r, const VehicleGiven& given, const engine::Vehicle& vehicle, int tower, engine::Body& body) {
  engine::Model& model = builder.scene.model;
  const engine::Body& front = model.bodies[static_cast<std::size_t>(tower)];
  const engine::Vec3 hitch_B = builder.hitches.at(front.name), coupling_B = *given.coupling - given.cg;
  const engine::Vec3 at = front.X_WB * hitch_B;
  if (!r.has("heading")) body.X_WB.q = front.X_WB.q;
  body.X_WB.p += at - body.X_WB * coupling_B;
  if (r.has("heading") && stands_freely(builder, r)) {
    const engine::Pose X_WM{body.X_WB * -given.cg, body.X_WB.q};
    body.X_WB.q = (along_ground(on_ground(model.ground, vehicle, given.cg, X_WM)) * body.X_WB.q).normalized();
    body.X_WB.p += at - body.X_WB * coupling_B;
  }
  const double height = given.coupling->z(),
               hitch = at.z() - ground_beneath(model.ground, at.x(), at.y()).value_or(model.ground.height);
  if (std::abs(height - hitch) > 0.02)
    r.warn("coupling",
           fmt::format("is {:.3g} m above the ground and the hitch {:.3g} m; the trailer is lifted to it", height, hitch));
  body.V_WB.w = front.V_WB.w;
  body.V_WB.v = front.V_WB.v + front.V_WB.w.cross(body.X_WB.p - front.X_WB.p);
  engine::Joint joint;
  joint.name = front.name + "-" + body.name;
  joint.parent = tower;
  joint.child = static_cast<int>(model.bodies.size());
  // a turntable turns about the joint frame's y, which is put upright
  joint.kind = given.coupling_kind == Coupling::turntable ? engine::JointKind::revolute : engine::JointKind::spherical;
  const engine::Quat upright = engine::math::rotation(0.5 * std::numbers::pi, engine::Vec3::UnitX());
  joint.X_PF = {hitch_B, upright};
  joint.X_CF = {coupling_B, (body.X_WB.q.conjugate() * front.X_WB.q * upright).normalized()};
  model.joints.push_back(joint);
}

}  // namespace

const Section kVehicleSection{"vehicle", "[[vehicle]]", "A vehicle: a rigid body on wheels.", kVehicleKeys};

void read_vehicle(Builder& builder, Reader scene) {
  engine::Model& model = builder.scene.model;
  const auto laid = with_model(builder, scene);
  if (!laid) return;
  Reader r(laid->tree, kVehicleSection, scene.path(), builder.errors);
  engine::Vehicle vehicle;
  r.fill(vehicle);
  if (vehicle.name.empty()) scene.fail("name", "must be given; every vehicle needs a name");
  if (builder.body_index(vehicle.name) >= 0) scene.fail("name", "this name is already used; every body needs a name of its own");
  const std::size_t errors_before = builder.errors.count();
  need(r, "mesh", "\"my_car.obj\"");
  need(r, "mass", "\"1500 kg\"");
  need(r, "cg", "\"0.1 0 0.55 m\"");
  need(r, "inertia", "\"550 2500 2700 kg m^2\"");
  if (builder.errors.count() != errors_before) {
    if (r.has("mesh")) import_mesh(builder, r, "mesh");  // what is wrong with it is told at once
    return;
  }
  // the library has its trailers, buses and bicycles; a mesh of the user's is most likely a car
  const Origin origin = scene.has("mesh") || !scene.has("model") ? Origin::user : Origin::library;
  const Meshes meshes = read_meshes(builder, r, origin);
  if (meshes.bodywork && origin == Origin::user)
    if (const int open = open_edges(*meshes.bodywork->solid->mesh()); open > 0)
      r.warn("mesh", fmt::format("is open at {} edges; what comes from behind its faces goes through", open));

  VehicleGiven given;
  Placing placing;
  engine::Body body;
  r.fill(given);
  r.fill(placing);
  r.fill(body);
  body.name = vehicle.name;
  if (laid->mass > 0 && body.mass > 0 && body.mass != laid->mass) {
    // radii of inertia of measured vehicles go by wheelbase and track, whatever their mass
    body.inertia_B *= body.mass / laid->mass;
    builder.assumed.warn(r.place("mass"), fmt::format("{} is {:.4g} times the model's; its inertia is taken as that many times the "
                                                      "model's, unless `inertia` is given",
                                                      r.path("mass"), body.mass / laid->mass));
  }
  check_inertia(r, "inertia", body.inertia_B);
  body.surface = read_surface(r, {});
  body.vehicle = static_cast<int>(model.vehicles.size());
  read_wheels(r, given.cg, vehicle);
  read_brake(r, body.mass, vehicle);
  read_driver(r, body.mass, vehicle);
  if (!meshes.bodywork || !meshes.collision) return;

  const engine::Pose X_BM{-given.cg, engine::Quat::Identity()};
  engine::Pose X_WM = mesh_pose(builder, r, given, placing, meshes);
  body.V_WB.v = placing.v(r);
  set_down(builder, r, vehicle, given.cg, X_WM, body.V_WB.v);
  body.shape = collision_shape(builder, meshes, X_BM, given.mesh_tolerance);
  body.X_WB = {X_WM * given.cg, X_WM.q.normalized()};
  if (const int tower = find_tower(builder, r); tower >= 0 && given.coupling) couple(builder, r, given, vehicle, tower, body);
  if (given.saddle) builder.saddles[vehicle.name] = *given.saddle - given.cg;
  if (given.hitch) builder.hitches[vehicle.name] = *given.hitch - given.cg;
  vehicle.body = static_cast<int>(model.bodies.size());
  add_actors(builder, given, vehicle, meshes, std::get<engine::MeshShape>(body.shape));
  model.bodies.push_back(std::move(body));
  model.vehicles.push_back(std::move(vehicle));
}

}  // namespace scenes
