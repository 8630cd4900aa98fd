#include "engine/effects/greatest_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace engine {
namespace {

/// How far [m] a body's centre can go from where joints hold it in the world. Infinity: nothing holds it, on a slide it has no end,
/// or a joint can break.
double tether(const Model& model, int body, std::size_t most_joints) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const auto holds = [&](const Joint& j) {
    return j.child == body && j.kind != JointKind::prismatic && j.kind != JointKind::cylindrical && std::isinf(j.breaking_force);
  };
  const auto joint = std::find_if(model.joints.begin(), model.joints.end(), holds);
  if (joint == model.joints.end() || most_joints == 0) return kNone;
  const Pose& X = model.bodies[static_cast<std::size_t>(body)].X_WB;
  const Vec3 at = X * joint->X_CF.p;
  const double own = (at - X.p).norm();
  if (joint->parent < 0) return own;
  const Body& parent = model.bodies[static_cast<std::size_t>(joint->parent)];
  return parent.fixed ? own : own + (at - parent.X_WB.p).norm() + tether(model, joint->parent, most_joints - 1);
}

/// How high [m] a body's centre stands, at least, on a level plane: a rigid one on its thinnest side.
double least_height(const Model& model, const Body& body) {
  const auto* shape = std::get_if<HyperEllipsoid>(&body.shape);
  return shape && !yields(model.settings.contact_law, body.person >= 0) ? shape->semi_axes.minCoeff() : 0;
}

/// How far [m] a body can fall. Onto a level plane no deeper than it stands there; else it falls all the time, as far as joints let
/// it.
double greatest_fall(const Model& model, std::size_t b) {
  const Body& body = model.bodies[b];
  const double T = model.settings.duration, g = model.settings.gravity.norm();
  const bool level = model.ground.plane && model.settings.gravity.head<2>().isZero(0);
  const double height = std::max(0.0, body.X_WB.p.z() - model.ground.height - least_height(model, body));
  const double falls = level ? height : body.V_WB.v.norm() * T + 0.5 * g * T * T;
  return std::min(falls, 2 * tether(model, static_cast<int>(b), model.joints.size()));
}

/// One body that nothing touches and nothing holds: its turning stays what it is.
bool turns_by_itself(const Model& model) {
  return model.bodies.size() == 1 && model.joints.empty() && !model.ground.plane && !model.ground.terrain;
}

}  // namespace

double greatest_energy(const Model& model) {
  double energy = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.fixed) continue;
    const Vec3 w = body.X_WB.q.conjugate() * body.V_WB.w;
    energy += 0.5 * body.mass * body.V_WB.v.squaredNorm() + body.mass * model.settings.gravity.norm() * greatest_fall(model, b);
    if (!turns_by_itself(model)) energy += 0.5 * w.dot(body.inertia_B * w);
  }
  for (const Vehicle& vehicle : model.vehicles)
    for (const Wheel& wheel : vehicle.wheels) energy += 0.5 * wheel.spring * wheel.travel * wheel.travel;
  return energy;
}

}  // namespace engine
