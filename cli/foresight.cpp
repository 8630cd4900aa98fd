#include "cli/foresight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "cli/disk_room.h"
#include "cli/film_plan.h"
#include "cli/output/summary.h"
#include "engine/effects/reach.h"
#include "engine/measure/approach.h"
#include "engine/plan.h"
#include "engine/simulate.h"
#include "engine/state.h"
#include "render/cameras.h"
#include "render/card.h"
#include "render/matrix.h"
#include "render/text/fonts.h"

namespace cli {
namespace {

using engine::Vec3;
using Sentences = std::vector<std::string>;

constexpr double kFastestVehicle = 250 / 3.6;  // [m/s] beyond it a unit is wrong more often than the accident is real
constexpr double kFastestPerson = 45 / 3.6;    // [m/s] the fastest sprint; riders are not held to it
constexpr double kHardestDriving = 10;         // [m/s^2] no tyre accelerates or brakes harder on the road
constexpr double kRoughestGround = 1.5;        // [-] beyond it no tyre or cloth on a road
constexpr double kHovers = 0.05;               // [m] of one that waits: poses stand within millimetres
constexpr double kHighestStart = 1;            // [m] of a person's lowest point
constexpr int kFirstSteps = 3;
constexpr int kLookAhead = 5000;  // steps; a check is no run
constexpr int kPieces = 20;       // of them, after each of which it is asked whether something has touched

/// What moves as one: a vehicle, a person, a free body.
struct Thing {
  std::string name;
  std::vector<int> bodies;
  Vec3 centre = Vec3::Zero();
  double radius = 0;        // [m] horizontally, about the centre
  double speed = 0;         // [m/s] at the start
  double acceleration = 0;  // [m/s^2] it may reach by itself
  bool fixed = false;
  int holds_on_to = -1;  // the body it rides or is towed by: touching that is no accident
};

double radius_of(const engine::Body& body) {
  if (const auto* ellipsoid = std::get_if<engine::HyperEllipsoid>(&body.shape)) return ellipsoid->semi_axes.norm();
  if (const auto* mesh = std::get_if<engine::MeshShape>(&body.shape)) {
    const auto bounds = mesh->mesh->bounds();
    return bounds.lower.cwiseAbs().cwiseMax(bounds.upper.cwiseAbs()).norm() + mesh->X_BM.p.norm();
  }
  return 0;
}

Thing thing_of(const engine::Model& model, const std::string& name, const std::vector<int>& bodies) {
  Thing out;
  out.name = name;
  out.bodies = bodies;
  out.fixed = true;
  for (const int b : bodies) {
    const engine::Body& body = model.bodies[static_cast<std::size_t>(b)];
    out.centre += body.X_WB.p / static_cast<double>(bodies.size());
    out.speed = std::max(out.speed, body.V_WB.v.norm());
    out.fixed = out.fixed && body.fixed;
  }
  for (const int b : bodies) {
    const engine::Body& body = model.bodies[static_cast<std::size_t>(b)];
    out.radius = std::max(out.radius, (body.X_WB.p - out.centre).norm() + radius_of(body));
  }
  return out;
}

std::vector<Thing> things_of(const engine::Model& model) {
  std::vector<Thing> out;
  for (const engine::Vehicle& vehicle : model.vehicles) {
    out.push_back(thing_of(model, vehicle.name, {vehicle.body}));
    out.back().acceleration = kHardestDriving;
  }
  for (const engine::Person& person : model.persons) {
    out.push_back(thing_of(model, person.name, person.bodies));
    out.back().holds_on_to = person.mount;
  }
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const engine::Body& body = model.bodies[static_cast<std::size_t>(b)];
    if (body.person < 0 && body.vehicle < 0) out.push_back(thing_of(model, body.name, {b}));
  }
  return out;
}

/// The first steps of the run: what overlaps at the start, what cannot be computed at all.
Sentences first_steps(const scenes::Scene& scene) {
  engine::Model model = scene.model;
  model.settings.duration = std::min(model.settings.duration, kFirstSteps * model.settings.step);
  // an exchange that is settled for a pair comes later
  std::erase_if(model.impacts, [&](const engine::ImpactSettings& s) {
    const auto collision = [&](int b) { return model.bodies[static_cast<std::size_t>(b)].collision_model; };
    return engine::model_between(collision(s.body_a), collision(s.body_b)) == engine::CollisionModel::kudlich_slibar;
  });
  const engine::Recording recording = engine::simulate(model);
  Sentences out = recording.diagnostics.warnings;
  if (const auto& failure = recording.failure)
    out.push_back(fmt::format("the model diverges at {:.4f} s, body {}, effect {}: {}", failure->time, failure->body,
                              failure->effect, failure->message));
  return out;
}

/// A scheme asked for that the scene leaves nothing to do.
Sentences other_scheme(const engine::Model& model) {
  const engine::Plan plan = engine::compile(model);
  if (plan.integrated_by == model.settings.scheme) return {};
  return {scheme_in_words(model, plan)};
}

Sentences unlikely_speeds(const engine::Model& model) {
  Sentences out;
  const auto tell = [&out](const std::string& name, double speed, double most) {
    if (speed > most)
      out.push_back(
          fmt::format("{} starts at {:.4g} km/h, faster than {:.4g} km/h; is the unit right?", name, 3.6 * speed, 3.6 * most));
  };
  for (const engine::Vehicle& vehicle : model.vehicles)
    tell(vehicle.name, model.bodies[static_cast<std::size_t>(vehicle.body)].V_WB.v.norm(), kFastestVehicle);
  for (const engine::Person& person : model.persons)
    if (person.mount < 0) tell(person.name, model.bodies[static_cast<std::size_t>(person.hips)].V_WB.v.norm(), kFastestPerson);
  return out;
}

/// Masses, places of the centre of mass and wheel angles that no vehicle has.
Sentences unlikely_figures(const engine::Model& model) {
  // [kg/m^3] of the box round the bodywork; cars have 110 to 145, a bicycle 20
  constexpr double kDensest = 1000, kLightest = 20, kLightestTwoWheeler = 3;
  constexpr double kFarthest = 1.2;  // [rad] of a steered wheel
  Sentences out;
  for (const engine::Vehicle& vehicle : model.vehicles) {
    const engine::Body& body = model.bodies[static_cast<std::size_t>(vehicle.body)];
    if (const auto* shell = std::get_if<engine::MeshShape>(&body.shape)) {
      const auto box = shell->mesh->bounds();
      const Vec3 size = box.upper - box.lower, cg = shell->X_BM.inverse() * Vec3::Zero();
      const double density = body.mass / std::max(1e-9, size.prod());
      if (density > kDensest || density < (has_track(vehicle) ? kLightest : kLightestTwoWheeler))
        out.push_back(
            fmt::format("{} has a mass of {:.4g} kg and is {:.3g} m long, {:.3g} m wide and {:.3g} m high; is the unit right?",
                        vehicle.name, body.mass, size.x(), size.y(), size.z()));
      if ((cg - box.lower).minCoeff() < 0 || (box.upper - cg).minCoeff() < 0)
        out.push_back(fmt::format("{} has its centre of mass outside its bodywork, {:.3g} m above the road; is the unit right?",
                                  vehicle.name, cg.z()));
    }
    double most = 0;
    for (const auto& knot : vehicle.steer.knots()) most = std::max(most, std::abs(knot.value));
    if (most > kFarthest)
      out.push_back(fmt::format("{} steers by up to {:.4g} deg, farther than {:.3g} deg; is the unit right?", vehicle.name,
                                most * 180 / std::numbers::pi, kFarthest * 180 / std::numbers::pi));
  }
  return out;
}

/// The lowest point of a person's parts, beneath the centre of one.
Vec3 lowest_of(const engine::Model& model, const engine::Person& person) {
  Vec3 lowest(0, 0, 1e300);
  for (const int b : person.bodies) {
    const engine::Body& body = model.bodies[static_cast<std::size_t>(b)];
    const double z = engine::box_at_start(body).lower.z();
    if (is_round(body) && z < lowest.z()) lowest = {body.X_WB.p.x(), body.X_WB.p.y(), z};
  }
  return lowest;
}

/// Whether somebody or something else, a kerb, a lorry's roof, lies less than kHighestStart beneath the point.
bool is_over_something(const engine::Model& model, const engine::Person& person, const Vec3& point) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), [&](const engine::Body& body) {
    const engine::Aabb box = engine::box_at_start(body);
    const bool own = body.person >= 0 && &model.persons[static_cast<std::size_t>(body.person)] == &person;
    if (point.z() - box.upper.z() > kHighestStart) return false;
    return !own && (box.lower.array() <= point.array()).all() && (box.upper.array() >= point.array()).head<2>().all();
  });
}

Sentences unlikely_ground(const engine::Model& model) {
  Sentences out;
  const double friction = model.ground.surface.friction_ground.at(0);
  if (friction > kRoughestGround) out.push_back(fmt::format("ground.friction is {:.3g}; dry asphalt has 0.7 to 0.8", friction));
  if (model.ground.terrain || !model.ground.plane) return out;
  // `height` taken for the stature; who shall fall from that high reads it once
  for (const engine::Person& person : model.persons) {
    const Vec3 lowest = lowest_of(model, person);
    const double z = lowest.z() - model.ground.height;
    if (person.mount >= 0 || z >= 1e3) continue;
    const bool over = is_over_something(model, person, lowest);
    if (z > kHighestStart && !over)
      out.push_back(fmt::format("{} starts {:.3g} m above the ground; the length of the body is `stature`", person.name, z));
    else if (z > kHovers && person.zero_condition && !over)
      out.push_back(fmt::format(
          "{} hovers {:.3g} m above the ground until something touches it; zero_condition = false lets it fall", person.name, z));
  }
  return out;
}

bool belong_together(const engine::Model& model, const Thing& a, const Thing& b) {
  const auto has = [](const Thing& thing, int body) {
    return std::find(thing.bodies.begin(), thing.bodies.end(), body) != thing.bodies.end();
  };
  if (has(b, a.holds_on_to) || has(a, b.holds_on_to)) return true;
  return std::any_of(model.joints.begin(), model.joints.end(), [&](const engine::Joint& j) {
    return (has(a, j.parent) && has(b, j.child)) || (has(b, j.parent) && has(a, j.child));
  });
}

/// Objects so far from all others that nothing brings them together before the run ends. Slopes, terrain and sections of effects
/// (wind) are left out of it: there it is not known without computing.
Sentences out_of_reach(const engine::Model& model) {
  const std::vector<Thing> things = things_of(model);
  const Vec3& gravity = model.settings.gravity;
  if (!model.inputs.empty()) return {};  // sections of effects: wind, say
  if (things.size() < 2 || model.ground.terrain || !model.ground.plane || gravity.head<2>().norm() > 0) return {};
  const double time = model.settings.duration;
  const auto reach = [time](const Thing& t) { return t.fixed ? 0 : t.speed * time + 0.5 * t.acceleration * time * time; };
  Sentences out;
  for (const Thing& a : things) {
    bool alone = true, free = false;
    double nearest = 1e300;
    for (const Thing& b : things) {
      if (&a == &b || belong_together(model, a, b)) continue;
      free = true;
      const double gap = (a.centre - b.centre).head<2>().norm() - a.radius - b.radius;
      nearest = std::min(nearest, gap);
      alone = alone && gap > reach(a) + reach(b);
    }
    if (alone && free)
      out.push_back(fmt::format(
          "{} can touch nothing: at the start it is at least {:.3g} m from the nearest other object, too far for {:.3g} s", a.name,
          nearest, time));
  }
  return out;
}

/// Whether the camera sees any of the things where they are at the start or would be later, each on its straight way.
bool sees_something(const render::Camera& camera, const engine::Model& model, double aspect) {
  const Vec3 axis = (camera.target - camera.position).normalized();
  const double half = std::atan(std::tan(camera.vertical_fov / 2) * std::hypot(1.0, aspect));  // to the picture's corner
  for (const Thing& thing : things_of(model)) {
    const engine::Body& body = model.bodies[static_cast<std::size_t>(thing.bodies.front())];
    for (int i = 0; i <= 20; ++i) {
      const double t = model.settings.duration * i / 20;
      const Vec3 way =
          thing.centre + (body.fixed ? Vec3::Zero() : Vec3(body.V_WB.v.x() * t, body.V_WB.v.y() * t, 0)) - camera.position;
      const double distance = way.norm();
      if (distance <= thing.radius) return true;
      const double angle = std::acos(std::clamp(way.dot(axis) / distance, -1.0, 1.0));
      if (angle - std::asin(thing.radius / distance) <= half) return true;
    }
  }
  return false;
}

Sentences blind_cameras(const scenes::Scene& scene) {
  Sentences out;
  const render::Stage& stage = scene.stage;
  const double aspect = static_cast<double>(scene.output.width) / scene.output.height;
  for (const render::Camera& camera : stage.cameras) {
    const bool aims = camera.kind == render::CameraKind::fixed && camera.follow.empty();
    if (aims && !sees_something(camera, scene.model, aspect))
      out.push_back(fmt::format("camera {} looks away: no vehicle, person or body comes into its picture", camera.name));
  }
  return out;
}

Sentences room_on_disk(const scenes::Scene& scene, const std::string& output) {
  int frames = 0;
  try {
    frames = render::Film(scene.stage, scene.model.settings.duration, scene.output.fps).size();
  } catch (const render::FilmTooLong& error) {
    return {error.what()};
  }
  const std::optional<std::string> told = short_of_room(film_job(output, scene), frames);
  return told ? Sentences{*told} : Sentences{};
}

/// Whether two things of an accident could have met: a vehicle or a person, and something it does not ride, tow or hang on.
bool could_meet(const engine::Model& model) {
  const std::vector<Thing> things = things_of(model);
  const auto acts = [&model](const Thing& thing) {
    const engine::Body& body = model.bodies[static_cast<std::size_t>(thing.bodies.front())];
    return body.vehicle >= 0 || body.person >= 0;
  };
  for (const Thing& a : things)
    for (const Thing& b : things)
      if (&a != &b && acts(a) && !belong_together(model, a, b)) return true;
  return false;
}

bool is_touch(const engine::Model& model, const engine::ContactRecord& contact) {
  if (contact.body_a < 0 || contact.body_b < 0) return false;
  const engine::Body& a = model.bodies[static_cast<std::size_t>(contact.body_a)];
  const engine::Body& b = model.bodies[static_cast<std::size_t>(contact.body_b)];
  return !(a.person >= 0 && a.person == b.person) && (contact.normal_impulse > 0 || contact.state == engine::ContactState::impact);
}

/// Vehicles and persons some of which drive or walk, and never meet, in the first kLookAhead steps: who comes nearest.
Sentences misses(const scenes::Scene& scene) {
  engine::Model model = scene.model;
  const auto moves = [](const engine::Body& body) { return !body.V_WB.v.isZero(); };
  if (!could_meet(model) || std::none_of(model.bodies.begin(), model.bodies.end(), moves)) return {};
  const engine::Plan plan = engine::compile(model);
  const double end = std::min(model.settings.duration, kLookAhead * model.settings.step);
  engine::State state;
  std::optional<engine::Approach> nearest;
  std::set<std::string> over;
  for (int piece = 1; piece <= kPieces; ++piece) {
    model.settings.duration = end * piece / kPieces;
    engine::RunOptions options;
    options.from = piece > 1 ? &state : nullptr;
    options.end = &state;
    const engine::Recording recording = engine::simulate(model, plan, options);
    if (recording.failure || !nothing_touched(model, recording)) return {};
    for (const std::string& name : under_wheels(model, recording)) over.insert(name);
    const auto found = engine::nearest_approach(model, recording);
    if (found && (!nearest || found->distance < nearest->distance)) nearest = found;
    if (recording.end_time() < model.settings.duration - model.settings.step) break;  // all rest
  }
  if (!nearest) return {};
  const std::string until = end < scene.model.settings.duration ? fmt::format(" in the first {:.3g} s", end) : "";
  const std::string but = over.empty() ? "" : fmt::format(" but wheels and {}", fmt::join(over, " and "));
  return {fmt::format("nothing touches{}{}: {} and {} come no nearer than {:.2f} m, at {:.2f} s", but, until,
                      model.bodies[nearest->body_a].name, model.bodies[nearest->body_b].name, nearest->distance, nearest->time)};
}

}  // namespace

std::vector<std::string> inside_vehicles(const engine::Model& model) {
  Sentences out;
  for (const engine::Person& person : model.persons)
    for (const engine::Vehicle& vehicle : model.vehicles) {
      const engine::Body& car = model.bodies[static_cast<std::size_t>(vehicle.body)];
      const auto* shell = std::get_if<engine::MeshShape>(&car.shape);
      if (!shell || person.mount == vehicle.body) continue;
      const Vec3 hips = shell->X_BM.inverse() * (car.X_WB.inverse() * model.bodies[static_cast<std::size_t>(person.hips)].X_WB.p);
      const auto bounds = shell->mesh->bounds();
      if ((hips - bounds.lower).minCoeff() > 0 && (bounds.upper - hips).minCoeff() > 0)
        out.push_back(fmt::format("{} stands inside {} at the start", person.name, vehicle.name));
    }
  return out;
}

std::vector<std::string> crowded_cards(const render::Stage& stage, int width, int height) {
  Sentences out;
  for (std::size_t i = 0; i < stage.cards.size(); ++i) {
    const std::size_t lines = stage.cards[i].lines.size(),
                      fitting = render::card_page(stage, stage.cards[i], width, height).fitting;
    if (fitting < lines)
      out.push_back(
          fmt::format("card {} has {} lines, of which {} fit on {}x{} in letters that can be read; the others are left out", i + 1,
                      lines, fitting, width, height));
  }
  return out;
}

std::vector<std::string> under_wheels(const engine::Model& model, const engine::Recording& recording) {
  constexpr double kAbove = 1e-3;  // [m] the plane: what lies level in it is road
  constexpr double kTread = 5e-3;  // [m] by which a tread may stand off a box
  Sentences out;
  for (const engine::Body& body : model.bodies) {
    if (!body.fixed || body.person >= 0 || body.vehicle >= 0) continue;
    const engine::Aabb box = engine::box_at_start(body);
    const auto on_it = [&](const engine::WheelRecord& wheel) {
      const bool above = !model.ground.plane || wheel.contact.z() > model.ground.height + kAbove;
      return wheel.load > 0 && above && ((wheel.contact - box.lower).array() > -kTread).all() &&
             ((box.upper - wheel.contact).array() > -kTread).all();
    };
    const auto rolled = [&](const engine::Snapshot& s) { return std::any_of(s.wheels.begin(), s.wheels.end(), on_it); };
    if (std::any_of(recording.snapshots.begin(), recording.snapshots.end(), rolled)) out.push_back(body.name);
  }
  return out;
}

bool nothing_touched(const engine::Model& model, const engine::Recording& recording) {
  if (!could_meet(model)) return false;
  const auto touches = [&](const engine::Snapshot& snapshot) {
    return std::any_of(snapshot.contacts.begin(), snapshot.contacts.end(),
                       [&](const engine::ContactRecord& contact) { return is_touch(model, contact); });
  };
  if (std::any_of(recording.snapshots.begin(), recording.snapshots.end(), touches)) return false;
  // two that an impulse model had overlap and part without one
  const auto nearest = engine::nearest_approach(model, recording);
  return !nearest || nearest->distance > 0;
}

namespace {

/// Of the film, and of snapshots that show cards.
Sentences crowded_pages(const scenes::Scene& scene) {
  Sentences out = crowded_cards(scene.stage, scene.output.width, scene.output.height);
  const auto& stills = scene.output.stills;
  if (std::none_of(stills.begin(), stills.end(), [](const auto& still) { return still.card >= 0; })) return out;
  for (std::string& crowded : crowded_cards(scene.stage, scene.snapshot.width, scene.snapshot.height))
    if (std::find(out.begin(), out.end(), crowded) == out.end()) out.push_back(std::move(crowded));
  return out;
}

/// Titles, names and cards with letters that pictures show as boxes.
Sentences letters_without_glyph(const scenes::Scene& scene) {
  std::string all = scene.stage.title;
  for (const Thing& thing : things_of(scene.model)) all += thing.name;
  for (const render::Shot& shot : scene.stage.shots) all += shot.title;
  for (const render::Card& card : scene.stage.cards) {
    all += card.title;
    for (const std::string& line : card.lines) all += line;
  }
  const std::string lacking = render::without_glyph(all);
  if (lacking.empty()) return {};
  return {fmt::format("the font of pictures, {}, has no glyph for {}: they may show as boxes", render::kFont, lacking)};
}

}  // namespace

std::vector<std::string> foresee(const scenes::Scene& scene, const std::string& output) {
  Sentences out = inside_vehicles(scene.model);  // first: why the first steps find what they find
  const bool inside = !out.empty();
  const Sentences far = out_of_reach(scene.model);
  for (const Sentences& more :
       {first_steps(scene), other_scheme(scene.model), unlikely_speeds(scene.model), unlikely_figures(scene.model),
        unlikely_ground(scene.model), far, inside || !far.empty() ? Sentences() : misses(scene), blind_cameras(scene),
        unfit_riders(scene.model), crowded_pages(scene), letters_without_glyph(scene), room_on_disk(scene, output)})
    out.insert(out.end(), more.begin(), more.end());
  return out;
}

bool is_empty_picture(const engine::Model& model, const render::Stage& stage, const engine::Recording& recording,
                      const render::Moment& moment, double aspect) {
  const auto camera = std::find_if(stage.cameras.begin(), stage.cameras.end(),
                                   [&](const render::Camera& candidate) { return candidate.name == moment.camera; });
  if (camera == stage.cameras.end() || moment.layout != render::Layout::single) return false;
  const render::View view = render::view_of(*camera, recording, moment.time, aspect);
  const Eigen::Matrix4d to_eye = render::from_gl(view.world_to_eye), to_clip = render::from_gl(view.eye_to_clip);
  const engine::Snapshot now = recording.at(moment.time);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Eigen::Vector4d eye = to_eye * now.bodies[b].X_WB.p.homogeneous();
    const Eigen::Vector4d clip = to_clip * eye;
    const double radius = radius_of(model.bodies[b]);
    if (!view.orthographic && eye.z() > radius) continue;  // behind
    // a plane of the frustum leans: at most its own length of coefficients times the radius nearer
    bool inside = true;
    for (int side = 0; side < 2; ++side) {
      const double reach = radius * std::hypot(to_clip(side, side), view.orthographic ? 0 : 1);
      inside = inside && std::abs(clip[side]) <= clip.w() + reach;
    }
    if (inside) return false;
  }
  return true;
}

}  // namespace cli
