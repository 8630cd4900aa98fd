// Does a rider fit what it rides? Hands, feet and seat hold on where the pose has them, be that in the air.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cli/foresight.h"
#include "engine/geometry/point_mesh.h"

namespace cli {
namespace {

using engine::Vec3;

// [m] from the middle of a hand or foot to anything of the mount. Hands of riders of 1.5 to 2 m are 9 cm from the library's
// two-wheelers at most, those of a child of six 17 cm. A foot of 2 m hangs 15 cm below its pedal: such a rider has raised the
// saddle
constexpr double kHandHolds = 0.12, kFootHolds = 0.2;

std::string part_of(const engine::Body& body) {
  return body.name.substr(body.name.find('/') + 1);
}

/// Parts that hold on to nothing.
std::vector<std::string> empty_holds(const engine::Model& model, const engine::Person& person) {
  const engine::Body& mount = model.bodies[static_cast<std::size_t>(person.mount)];
  const auto* shape = std::get_if<engine::MeshShape>(&mount.shape);
  std::vector<std::string> out;
  std::vector<int> scratch;
  for (const engine::Joint& hold : model.joints) {
    const bool own = std::find(person.bodies.begin(), person.bodies.end(), hold.child) != person.bodies.end();
    if (!shape || hold.parent != person.mount || !own || !std::isfinite(hold.breaking_force)) continue;
    const Vec3 place_M = shape->X_BM.inverse() * hold.X_PF.p;
    const std::string part = part_of(model.bodies[static_cast<std::size_t>(hold.child)]);
    if (!engine::nearest_surface(*shape->mesh, place_M, part.ends_with("foot") ? kFootHolds : kHandHolds, scratch))
      out.push_back(part);
  }
  return out;
}

/// The joint by which a body hangs on another of the same person; null for the root.
const engine::Joint* joint_above(const engine::Model& model, const engine::Person& person, int body) {
  const auto own = [&](int b) { return std::find(person.bodies.begin(), person.bodies.end(), b) != person.bodies.end(); };
  const auto at = std::find_if(model.joints.begin(), model.joints.end(),
                               [&](const engine::Joint& j) { return j.child == body && own(j.parent); });
  return at == model.joints.end() ? nullptr : &*at;
}

struct Leg {
  double length = 0;  // [m] stretched, from the hip to the sole
  double hip_z = 0;   // [m] world
};

/// From a foot up to the hips; nothing where they are not joined so.
std::optional<Leg> leg_above(const engine::Model& model, const engine::Person& person, int foot) {
  const auto* shape = std::get_if<engine::HyperEllipsoid>(&model.bodies[static_cast<std::size_t>(foot)].shape);
  Leg out;
  const engine::Joint* below = nullptr;
  for (int b = foot; b != person.hips;) {
    const engine::Joint* above = joint_above(model, person, b);
    if (!above || !shape) return std::nullopt;
    out.length += below ? (above->X_CF.p - below->X_PF.p).norm() : above->X_CF.p.z() + shape->semi_axes.z();
    below = above;
    b = above->parent;
  }
  if (!below) return std::nullopt;
  out.hip_z = (model.bodies[static_cast<std::size_t>(person.hips)].X_WB * below->X_PF.p).z();
  return out;
}

/// How much too short the legs are to reach down to the axles, about as high as pedals and foot rests; empty: long enough.
std::string short_legs(const engine::Model& model, const engine::Person& person) {
  const engine::Body& mount = model.bodies[static_cast<std::size_t>(person.mount)];
  double axle = -1e300;
  for (const engine::Wheel& wheel : model.vehicles[static_cast<std::size_t>(mount.vehicle)].wheels)
    axle = std::max(axle, (mount.X_WB * wheel.hub_B).z());
  for (const int b : person.bodies) {
    if (!part_of(model.bodies[static_cast<std::size_t>(b)]).ends_with("foot")) continue;
    const auto leg = leg_above(model, person, b);
    if (leg && leg->length < leg->hip_z - axle)
      return fmt::format("its legs are {:.2f} m long and do not reach down to the axles, {:.2f} m below its hips", leg->length,
                         leg->hip_z - axle);
  }
  return {};
}

}  // namespace

std::vector<std::string> unfit_riders(const engine::Model& model) {
  std::vector<std::string> out;
  for (const engine::Person& person : model.persons) {
    if (person.mount < 0 || model.bodies[static_cast<std::size_t>(person.mount)].vehicle < 0) continue;
    std::vector<std::string> why;
    const std::vector<std::string> holds = empty_holds(model, person);
    if (!holds.empty())
      why.push_back(fmt::format("{} {} nothing within reach", fmt::join(holds, " and "), holds.size() == 1 ? "holds" : "hold"));
    if (const std::string legs = short_legs(model, person); !legs.empty()) why.push_back(legs);
    if (!why.empty())
      out.push_back(fmt::format("{} does not fit {}: {}; is it of that size, and in that pose?", person.name,
                                model.bodies[static_cast<std::size_t>(person.mount)].name, fmt::join(why, "; ")));
  }
  return out;
}

}  // namespace cli
